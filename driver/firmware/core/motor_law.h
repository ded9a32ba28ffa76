#pragma once

#include <stdint.h>

namespace thimble {
namespace firmware {

// From the current of a motor to the output of a board. A number that is not finite gives zero.

/// Motor on a bridge without current sensing: the duty cycle sets the voltage.
struct VoltageMotor {
  float resistance = 1;  ///< Winding and bridge, ohm.
  float back_emf = 0;    ///< Voltage per speed, V s/rad.
  float supply = 12;     ///< Supply of the bridge, V.
};

/// Limits a number to -1..1; NaN becomes 0.
inline float unit_limited(float value) noexcept {
  if (value > 1.0f) return 1.0f;
  if (value < -1.0f) return -1.0f;
  return value == value ? value : 0.0f;
}

/// Returns the duty cycle, -1 to 1, for a current (A) at a speed of the motor (rad/s): the voltage
/// over the winding plus the induced voltage. With `back_emf` zero, the current is less than
/// requested while the motor turns with its torque, which only damps.
inline float duty_of(const VoltageMotor& motor, float amperes, float speed) noexcept {
  return unit_limited((amperes * motor.resistance + motor.back_emf * speed) / motor.supply);
}

/// Returns the duty cycle of the reference of a current amplifier, 0 to 1: `low` at minus `range`
/// (A), `high` at plus `range`. ESCON amplifiers use 0.1 and 0.9 [S maxon ESCON hardware reference,
/// "PWM set value"].
inline float reference_of(float amperes, float range, float low, float high) noexcept {
  return low + (high - low) * 0.5f * (1.0f + unit_limited(amperes / range));
}

}  // namespace firmware
}  // namespace thimble
