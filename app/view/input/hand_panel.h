#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "view/camera.h"
#include "view/input/hand_input.h"
#include "view/input/space_mouse.h"
#include "view/text_style.h"

namespace thimble::view {

/// Reads keyboard, gamepad and SpaceMouse for the simulated hand, shows who leads it, and draws its
/// target. To be called between ImGui's NewFrame and Render. Real-time: never from the servo
/// thread.
class HandPanel {
 public:
  HandInput& input() { return input_; }
  const HandInput& input() const { return input_; }

  /// Reads what leads the hand and moves its target; `keys`: pressed since the last picture
  /// (GLFW_KEY_...), `moves`: whether the run goes on.
  void step(const std::vector<int>& keys, const Camera& camera, const Eigen::Vector3d& p_WT,
            const Eigen::AlignedBox3d& reach, double dt, bool moves);

  /// Draws the target where the hand is held: a ghost of the tip, with a line to it.
  void draw_target(const HandWish& hand, const Eigen::Vector3d& p_WT, const Camera& camera,
                   const ScreenPart& part) const;
  /// Draws the box in which a person chooses who leads the hand, and reads whether it is held.
  /// Returns whether another source was chosen.
  bool draw_box(bool held, const ScreenPart& part);

 private:
  HandPush read(const std::vector<int>& keys);
  HandPush read_gamepad();

  HandInput input_;
  SpaceMouse space_mouse_;
  bool speed_held_ = false;  // the gamepad button that changes the speed
  std::string trouble_;      // why the source tells nothing; empty: it does
};

}  // namespace thimble::view
