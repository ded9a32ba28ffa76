#pragma once

#include <Eigen/Core>

#include "view/input/space_mouse_report.h"

namespace thimble::view {

/// A person's push of the hand's target, as fractions (-1 to 1) of its speed.
struct HandPush {
  Eigen::Vector3d share{0, 0, 0};  ///< Right, up and towards the eye, in the picture.
  bool slow = false;
  bool let_go = false;  ///< Requests to release the hand.

  /// Returns whether the push is not zero.
  bool any() const { return !share.isZero(0); }
};

/// The keys of the hand that are held.
struct HandKeys {
  bool left = false, right = false, up = false, down = false;
  bool nearer = false, farther = false;  ///< Towards the eye, away from it.
  bool slow = false, let_go = false;
};

/// Returns the push of keys: each at full speed; two opposite keys cancel out.
HandPush push_of(const HandKeys& keys);

/// The part of a gamepad's state (GLFWgamepadstate) that is used.
struct GamepadState {
  Eigen::Vector2d left{0, 0};  ///< Left stick: right, down; -1 to 1.
  double left_trigger = -1;    ///< -1: released; 1: pulled.
  double right_trigger = -1;
  bool slow = false, let_go = false;
};

/// Fraction of a stick's range about its middle that is ignored.
/// [S] Microsoft's XInput.h: XINPUT_GAMEPAD_LEFT_THUMB_DEADZONE 7849 of 32767.
inline constexpr double kStickDeadZone = 7849.0 / 32767;
/// Fraction of a trigger's range that is ignored. [S] XInput.h: XINPUT_GAMEPAD_TRIGGER_THRESHOLD 30
/// of 255.
inline constexpr double kTriggerDeadZone = 30.0 / 255;

/// Returns the push of a gamepad: the left stick right and up, the right trigger away from the eye,
/// the left one towards it. It is zero within the dead zones and begins at zero at their edges. A
/// stick's dead zone is radial, so that no direction is preferred.
HandPush push_of(const GamepadState& pad);

/// Fraction of the cap's range that is ignored. [chosen: more than the few counts that devices
/// report at rest; spacenavd's example file also suggests some counts]
inline constexpr double kCapDeadZone = 0.05;

/// Returns the push of a SpaceMouse: the direction of its cap; its left button means slow, its
/// right one releases the hand.
HandPush push_of(const SpaceMouseState& mouse);

}  // namespace thimble::view
