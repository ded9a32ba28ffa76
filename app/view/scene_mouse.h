#pragma once

#include <Eigen/Core>

#include "view/camera.h"
#include "view/text_style.h"

namespace thimble::view {

/// Where the mouse wants the hand.
struct HandWish {
  Eigen::Vector3d p_WH{0, 0, 0};  ///< m
  bool holds = false;
};

/// Turns what the mouse does over the scene into a camera's way, and into the hand's.
///
/// Left: turn about the scene; right, middle or left with shift: move along; wheel: nearer and
/// farther. The other left (with control, or without if the mouse is the hand) leads the hand in a
/// plane across the line of sight; the wheel then pushes it along that line.
class SceneMouse {
 public:
  /// Looks at the mouse. `p_WT` is the tip (m), `part` where the scene is on the screen, and
  /// `hand_first` says which left leads the hand. To be called between ImGui's NewFrame and Render.
  void step(Camera& camera, const Eigen::Vector3d& p_WT, const ScreenPart& part, bool hand_first);

  /// Returns where the hand shall be.
  const HandWish& hand() const { return hand_; }

 private:
  enum class Drag { kNone, kOrbit, kPan, kHand };
  void begin(const Eigen::Vector3d& p_WT, bool hand_first);
  void lead(const Camera& camera, const ScreenPart& part);

  Drag drag_ = Drag::kNone;
  HandWish hand_;
  Eigen::Vector3d p_WGrip_{0, 0, 0};  // where the hand was taken, with the wheel's way, m
  Eigen::Vector2d grip_{0, 0};        // pixel from which it moves
};

}  // namespace thimble::view
