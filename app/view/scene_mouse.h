#pragma once

#include <Eigen/Core>

#include "view/camera.h"
#include "view/text_style.h"

namespace thimble::view {

/// Target of the hand from the mouse.
struct MouseHandTarget {
  Eigen::Vector3d p_WH{0, 0, 0};  ///< m
  bool holds = false;
};

/// Converts mouse input over the scene to motion of the camera and of the hand.
///
/// Left: orbit the scene; right, middle or left with shift: pan; wheel: zoom. Left with control
/// (without, if the mouse moves the hand) moves the hand in a plane across the line of sight; the
/// wheel then pushes it along that line.
class SceneMouse {
 public:
  /// Reads the mouse. `p_WT` is the tip (m), `part` the scene's part of the screen. `hand_first`:
  /// left moves the hand without control. Call between ImGui's NewFrame and Render.
  void step(Camera& camera, const Eigen::Vector3d& p_WT, const ScreenPart& part, bool hand_first);

  /// Returns the target of the hand.
  const MouseHandTarget& hand() const { return hand_; }

 private:
  enum class Drag { kNone, kOrbit, kPan, kHand };
  void begin(const Eigen::Vector3d& p_WT, bool hand_first);
  void lead(const Camera& camera, const ScreenPart& part);

  Drag drag_ = Drag::kNone;
  MouseHandTarget hand_;
  Eigen::Vector3d p_WGrip_{0, 0, 0};  // where the hand was taken, plus the wheel's push, m
  Eigen::Vector2d grip_{0, 0};        // pixel at which the drag began
};

}  // namespace thimble::view
