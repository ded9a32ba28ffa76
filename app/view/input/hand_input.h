#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string_view>

#include "view/camera.h"
#include "view/input/hand_push.h"
#include "view/scene_mouse.h"

namespace thimble::view {

/// What leads the simulated hand in the window.
enum class HandSource { kMouse, kKeyboard, kGamepad, kSpaceMouse };

/// The sources as `--hand` names them, in their order.
inline constexpr std::array<std::string_view, 4> kHandSources = {"mouse", "keyboard", "gamepad",
                                                                 "spacemouse"};

/// Returns the source of a name; nothing if it is none's.
std::optional<HandSource> hand_source_named(std::string_view name);

/// Moves the target of the simulated hand as a person pushes it, along the picture's axes.
///
/// The first push takes the hand, where its tip is; from then on the target stays where it was
/// pushed to, until the hand is let go. Then the hand stays where it is, and the next push takes it
/// anew. The target stays in the arm's workspace and within kLeash of the tip, so that what was
/// pushed far into a wall need not be pulled out as far.
class HandInput {
 public:
  /// Speeds of a full push, m/s. Chosen: from a search for a texture to a reach through a
  /// workspace.
  static constexpr std::array<double, 6> kSpeeds = {0.005, 0.01, 0.02, 0.05, 0.1, 0.2};
  static constexpr double kSlow = 0.2;  ///< What slow makes of it. Chosen.
  /// m; chosen: a hand of 300 N/m then pushes with 12 N, more than any arm holds.
  static constexpr double kLeash = 0.04;
  /// s; what a longer picture takes moves no more: a window that stood still makes no jump. Chosen.
  static constexpr double kFrameMost = 0.1;

  /// Returns what leads the hand.
  HandSource source() const { return source_; }
  /// Takes another source; what is held is let go.
  void choose(HandSource source);
  /// Lets the hand go.
  void let_go() { hand_.holds = false; }
  /// Returns whether the hand is held.
  bool holds() const { return hand_.holds; }
  /// Returns how fast a full push moves it, m/s.
  double speed() const { return kSpeeds[speed_]; }
  /// Takes the next speed, faster or slower; at the ends it stays.
  void change_speed(bool faster);

  /// Moves the target for a picture of `dt` (s). `p_WT` is the tip (m), `reach` the arm's workspace
  /// (m).
  void step(const HandPush& push, const Camera& camera, const Eigen::Vector3d& p_WT,
            const Eigen::AlignedBox3d& reach, double dt);

  /// Returns where the hand shall be.
  const HandWish& hand() const { return hand_; }

 private:
  HandSource source_ = HandSource::kMouse;
  std::size_t speed_ = 3;
  HandWish hand_;
};

}  // namespace thimble::view
