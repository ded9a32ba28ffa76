#pragma once

#include <array>
#include <cstdint>

#include "thimble/driver/export.h"
#include "thimble/driver/motor_currents.h"

namespace thimble::driver {

/// What the heat guard knows of an arm's motors.
struct HeatSettings {
  /// Current that each motor carries for ever, A. All zero: not known, and there is no heat guard.
  std::array<double, 3> continuous_current{};
  /// Time constant of each winding's temperature, s. Must be > 0 where a current is named.
  std::array<double, 3> time_constant{};
  /// Heat at the start, 0: as cold as the room, 1: the winding's limit.
  std::array<double, 3> at_start{};

  bool named() const noexcept { return continuous_current[0] > 0; }  ///< Returns whether it acts.
};

/// A thermal model of each motor's winding, of first order, that lowers the largest current before
/// the winding is too hot.
///
/// The heat h follows h' = ((I / I_continuous)^2 - h) / tau with the currents really sent, as the
/// message holds them; its update over a tick is exact for a current that is held. h = 1 is what
/// the continuous current reaches in the end: the winding's limit. From the heat 0.8 on the largest
/// current falls, down to the continuous one at 1, and h never passes 1 (proof: heat_guard.cpp).
/// All functions are Real-time: safe.
class THIMBLE_EXPORT HeatGuard {
 public:
  /// Heat from which on the user is warned and the largest current falls [chosen].
  static constexpr double kWarning = 0.8;

  /// Takes the arm's drives, and the longest time that a current may be held, s: after that the
  /// arm's own watchdog switches the motors off.
  HeatGuard(const HeatSettings& settings, const std::array<MotorDrive, 3>& drives,
            double longest_hold) noexcept;

  bool named() const noexcept { return named_; }  ///< Returns whether the arm file names it.

  /// Lets `dt` (s) pass with the currents that were sent last. A `dt` that is not above zero and
  /// finite is no time.
  void advance(double dt) noexcept;
  /// Takes the currents that were sent, mA, and whether they had to be scaled down.
  void sent(const std::array<std::int16_t, 3>& mA, bool scaled) noexcept;

  /// Returns the drives of the arm with the largest currents that the motors may carry now.
  const std::array<MotorDrive, 3>& drives() const noexcept { return drives_; }
  /// Returns the heat of each motor, 0 to 1.
  const std::array<double, 3>& heat() const noexcept { return heat_; }
  double heat_most() const noexcept { return heat_most_; }  ///< Returns the most that any reached.
  /// Returns the number of ticks in which a force was scaled down because of heat.
  std::uint64_t lowered() const noexcept { return lowered_; }

 private:
  void limit() noexcept;

  HeatSettings settings_;
  std::array<MotorDrive, 3> drives_;
  bool named_;
  std::array<double, 3> current_max_{};     // of the arm, A
  std::array<double, 3> slope_{};           // of the squared largest current over the heat
  std::array<double, 3> cool_{-1, -1, -1};  // heat up to which the arm's own current is allowed
  std::array<double, 3> heat_{};
  std::array<double, 3> load_{};  // (I / I_continuous)^2 of what was sent last
  std::array<double, 3> gain_{};  // 1 - exp(-dt / tau)
  double gain_dt_ = -1;           // that gain_ was computed for, s
  double heat_most_ = 0;
  bool limiting_ = false;  // a largest current is lower than the arm's
  std::uint64_t lowered_ = 0;
};

}  // namespace thimble::driver
