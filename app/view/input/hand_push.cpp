#include "view/input/hand_push.h"

#include <algorithm>
#include <cmath>

namespace thimble::view {
namespace {

/// Applies a radial dead zone to a vector; NaN gives zero.
template <class Vector>
Vector without_dead_zone(const Vector& v, double zone) {
  const double length = v.norm();
  if (!(length > zone)) return Vector::Zero();
  return v / length * std::min(1.0, (length - zone) / (1 - zone));
}

double as_number(bool held) {
  return held ? 1 : 0;
}

/// Converts the position of a trigger, -1 to 1 as in GLFW, to a fraction.
double pulled(double trigger) {
  const double share = (trigger + 1) / 2;
  if (!(share > kTriggerDeadZone)) return 0;
  return std::min(1.0, (share - kTriggerDeadZone) / (1 - kTriggerDeadZone));
}

}  // namespace

HandPush push_of(const HandKeys& keys) {
  return {{as_number(keys.right) - as_number(keys.left), as_number(keys.up) - as_number(keys.down),
           as_number(keys.nearer) - as_number(keys.farther)},
          keys.slow,
          keys.let_go};
}

HandPush push_of(const GamepadState& pad) {
  const Eigen::Vector2d stick = without_dead_zone(pad.left, kStickDeadZone);
  return {{stick.x(), -stick.y(), pulled(pad.left_trigger) - pulled(pad.right_trigger)},
          pad.slow,
          pad.let_go};
}

HandPush push_of(const SpaceMouseState& mouse) {
  const auto& counts = mouse.translation;
  // From right, down, towards the person to right, up, towards the eye.
  const Eigen::Vector3d cap = Eigen::Vector3d(counts[0], -counts[2], counts[1]) / kSpaceMouseFull;
  return {without_dead_zone(cap, kCapDeadZone), (mouse.buttons & 1U) != 0,
          (mouse.buttons & 2U) != 0};
}

}  // namespace thimble::view
