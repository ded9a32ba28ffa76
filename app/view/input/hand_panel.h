#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "view/camera.h"
#include "view/input/hand_input.h"
#include "view/input/space_mouse.h"
#include "view/text_style.h"

namespace thimble::view {

/// Reads keyboard, gamepad and SpaceMouse for the simulated hand, shows the chosen source, and
/// draws the hand's target. Call between ImGui's NewFrame and Render. Real-time: never from the
/// servo thread.
class HandPanel {
 public:
  HandInput& input() { return input_; }
  const HandInput& input() const { return input_; }

  /// Reads the source of the hand and moves its target. `keys`: pressed since the last picture
  /// (GLFW_KEY_...); `moves`: whether the run is not paused.
  void step(const std::vector<int>& keys, const Camera& camera, const Eigen::Vector3d& p_WT,
            const Eigen::AlignedBox3d& reach, double dt, bool moves);

  /// Draws the target while the hand is held: a ghost of the tip, with a line to it.
  void draw_target(const MouseHandTarget& hand, const Eigen::Vector3d& p_WT, const Camera& camera,
                   const ScreenPart& part) const;
  /// Draws the box for choosing the source of the hand. Returns whether another source was chosen.
  bool draw_box(bool held, const ScreenPart& part);

 private:
  HandPush read(const std::vector<int>& keys);
  HandPush read_gamepad();

  HandInput input_;
  SpaceMouse space_mouse_;
  bool speed_held_ = false;  // the gamepad button that changes the speed
  std::string trouble_;      // why the source has no data; empty: it has
};

}  // namespace thimble::view
