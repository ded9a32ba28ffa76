#pragma once

#include <Eigen/Core>

#include "view/input/space_mouse_report.h"

namespace thimble::view {

/// How a person pushes the hand's target: as shares (-1 to 1) of its speed.
struct HandPush {
  Eigen::Vector3d share{0, 0, 0};  ///< Right, up and towards the eye, as the picture is seen.
  bool slow = false;
  bool let_go = false;  ///< Asks to let the hand go.

  /// Returns whether the hand is pushed at all.
  bool any() const { return !share.isZero(0); }
};

/// The keys that move the hand, as they are held.
struct HandKeys {
  bool left = false, right = false, up = false, down = false;
  bool nearer = false, farther = false;  ///< Towards the eye, away from it.
  bool slow = false, let_go = false;
};

/// Returns how keys push: each at full speed; two that are against each other do not.
HandPush push_of(const HandKeys& keys);

/// A gamepad as GLFW maps it (GLFWgamepadstate), of which this takes a part.
struct GamepadState {
  Eigen::Vector2d left{0, 0};  ///< Left stick: right, down; -1 to 1.
  double left_trigger = -1;    ///< -1: let go; 1: pulled.
  double right_trigger = -1;
  bool slow = false, let_go = false;
};

/// Share of a stick's way about its middle that tells nothing.
/// [S] Microsoft's XInput.h: XINPUT_GAMEPAD_LEFT_THUMB_DEADZONE 7849 of 32767.
inline constexpr double kStickDeadZone = 7849.0 / 32767;
/// Share of a trigger's way that tells nothing. [S] XInput.h: XINPUT_GAMEPAD_TRIGGER_THRESHOLD 30
/// of 255.
inline constexpr double kTriggerDeadZone = 30.0 / 255;

/// Returns how a gamepad pushes: the left stick right and up, the right trigger away from the eye,
/// the left one towards it. Nothing within the dead zones, and from their edges on it begins at
/// zero (a stick's by its distance from the middle, so that no direction is held fast).
HandPush push_of(const GamepadState& pad);

/// Share of the cap's way that tells nothing. [chosen: more than the few counts that devices tell
/// at rest, for which spacenavd's example file suggests some counts too]
inline constexpr double kCapDeadZone = 0.05;

/// Returns how a SpaceMouse pushes: as its cap is pushed; its left button is slow, its right one
/// lets go.
HandPush push_of(const SpaceMouseState& mouse);

}  // namespace thimble::view
