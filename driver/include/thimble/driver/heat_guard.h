#pragma once

#include <array>
#include <cstdint>

#include "thimble/driver/export.h"
#include "thimble/driver/motor_currents.h"

namespace thimble::driver {

/// Thermal properties of the motors of an arm.
struct HeatSettings {
  /// Current that each motor can carry continuously, A. All zero: unknown, and there is no heat
  /// guard.
  std::array<double, 3> continuous_current{};
  /// Time constant of the winding temperature of each motor, s. Must be > 0 if a current is given.
  std::array<double, 3> time_constant{};
  /// Initial heat. 0: ambient temperature; 1: limit of the winding.
  std::array<double, 3> at_start{};

  /// Returns whether the heat guard is active.
  bool named() const noexcept { return continuous_current[0] > 0; }
};

/// First-order thermal model of each motor winding. It lowers the largest current before a winding
/// overheats.
///
/// The heat h follows h' = ((I / I_continuous)^2 - h) / tau, with the currents in the messages
/// sent. The update over a tick is exact for a constant current. h = 1 is the final value at the
/// continuous current: the limit of the winding. From a heat of 0.8 on the largest current falls,
/// down to the continuous one at 1, and h never exceeds 1 (proof: heat_guard.cpp). All functions
/// are Real-time: safe.
class THIMBLE_EXPORT HeatGuard {
 public:
  /// Heat above which the user is warned and the largest current falls [chosen].
  static constexpr double kWarning = 0.8;

  /// Constructs the model for the drives of an arm. `longest_hold` is the longest time that a
  /// current may be held, s; after it the arm's own watchdog switches the motors off.
  HeatGuard(const HeatSettings& settings, const std::array<MotorDrive, 3>& drives,
            double longest_hold) noexcept;

  bool named() const noexcept { return named_; }  ///< Returns whether the heat guard is active.

  /// Advances the model by `dt` (s) with the currents sent last. Ignores a `dt` that is not
  /// positive and finite.
  void advance(double dt) noexcept;
  /// Sets the currents that were sent, mA, and whether they had to be scaled down.
  void sent(const std::array<std::int16_t, 3>& mA, bool scaled) noexcept;

  /// Returns the drives of the arm, with the largest currents that are allowed now.
  const std::array<MotorDrive, 3>& drives() const noexcept { return drives_; }
  /// Returns the heat of each motor, 0 to 1.
  const std::array<double, 3>& heat() const noexcept { return heat_; }
  /// Returns the largest heat that any motor has reached.
  double max_heat() const noexcept { return max_heat_; }
  /// Former name of `max_heat`.
  [[deprecated("renamed to max_heat")]] double heat_most() const noexcept { return max_heat(); }
  /// Returns the number of ticks in which a force was scaled down because of heat.
  std::uint64_t lowered() const noexcept { return lowered_; }

 private:
  void limit() noexcept;

  HeatSettings settings_;
  std::array<MotorDrive, 3> drives_;
  bool named_;
  std::array<double, 3> current_max_{};  // Of the arm, A.
  std::array<double, 3> slope_{};        // Slope of the squared largest current over the heat.
  // Heat up to which the arm's own limit of current applies.
  std::array<double, 3> cool_{-1, -1, -1};
  std::array<double, 3> heat_{};
  std::array<double, 3> load_{};  // (I / I_continuous)^2 of the currents sent last.
  std::array<double, 3> gain_{};  // 1 - exp(-dt / tau)
  double gain_dt_ = -1;           // Time for which gain_ was computed, s.
  double max_heat_ = 0;
  bool limiting_ = false;  // True if a largest current is below the arm's limit.
  std::uint64_t lowered_ = 0;
};

}  // namespace thimble::driver
