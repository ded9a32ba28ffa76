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

/// Input devices for the simulated hand in the window.
enum class HandSource { kMouse, kKeyboard, kGamepad, kSpaceMouse };

/// The values of `--hand`, in the order of the sources.
inline constexpr std::array<std::string_view, 4> kHandSources = {"mouse", "keyboard", "gamepad",
                                                                 "spacemouse"};

/// Returns the source of a name; empty if there is none.
std::optional<HandSource> hand_source_named(std::string_view name);

/// Moves the target of the simulated hand by a person's input, along the picture's axes.
///
/// The first push starts the hand at the tip. From then on the target stays where it was pushed to,
/// until the hand is released. The hand then stays at its place, and the next push starts it again.
/// The target stays in the arm's workspace and within kLeash of the tip. This limits how far it
/// must be pulled back out of a wall.
class HandInput {
 public:
  /// Speeds of a full push, m/s. Chosen: from the search for a texture to a motion across a
  /// workspace.
  static constexpr std::array<double, 6> kSpeeds = {0.005, 0.01, 0.02, 0.05, 0.1, 0.2};
  static constexpr double kSlow = 0.2;  ///< Factor of slow motion. Chosen.
  /// m; chosen: a hand of 300 N/m then pushes with 12 N, more than any arm can hold.
  static constexpr double kLeash = 0.04;
  /// Longest duration of a picture that counts, s: after a stall of the window the target does not
  /// jump. Chosen.
  static constexpr double kFrameMax = 0.1;

  /// Returns the source of the hand.
  HandSource source() const { return source_; }
  /// Chooses another source and releases the hand.
  void choose(HandSource source);
  /// Releases the hand.
  void let_go() { hand_.holds = false; }
  /// Returns whether the hand is held.
  bool holds() const { return hand_.holds; }
  /// Returns the speed of a full push, m/s.
  double speed() const { return kSpeeds[speed_]; }
  /// Chooses the next faster or slower speed, if there is one.
  void change_speed(bool faster);

  /// Moves the target for a picture of `dt` (s). `p_WT` is the tip (m), `reach` the arm's workspace
  /// (m).
  void step(const HandPush& push, const Camera& camera, const Eigen::Vector3d& p_WT,
            const Eigen::AlignedBox3d& reach, double dt);

  /// Returns the target of the hand.
  const MouseHandTarget& hand() const { return hand_; }

 private:
  HandSource source_ = HandSource::kMouse;
  std::size_t speed_ = 3;
  MouseHandTarget hand_;
};

}  // namespace thimble::view
