#include "energy_guard_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "math/elementary.h"
#include "worst_direction.h"

namespace thimble::scene {
namespace {

/// Number of reports over which the periods of loop and arm are averaged [chosen: periods of whole
/// hertz and microseconds repeat, almost or exactly, within that number].
constexpr int kReportsLookedAt = 5040;

}  // namespace

double loop_delay(const ArmFile& arm) {
  if (!arm.can_simulate || arm.is<driver::DeltaArm>()) return 0.001;
  return 1e-9 *
         static_cast<double>(arm.simulated.wire.delay_in_ns + arm.simulated.wire.delay_out_ns);
}

LoopTimes loop_pace(const ArmFile& arm, double rate) {
  LoopTimes times{.period = 1 / rate, .delay = loop_delay(arm)};
  // The board of a Falcon reports only on request.
  if (!arm.can_simulate || arm.is<driver::DeltaArm>()) return times;
  const std::int64_t report_ns = arm.simulated.firmware.report_period_ns;
  if (!(rate > 0 && rate <= 1e9) || report_ns <= 0) return times;
  const std::int64_t tick_ns = std::llround(1e9 / rate);
  // Sums over the ticks that receive a new report, from the arrival of the first report, and the
  // age of each report in its tick.
  std::int64_t last_ns = 0, last_wait_ns = 0;
  double total = 0, squares = 0, waited = 0;
  for (int taken = 0; taken < kReportsLookedAt; ++taken) {
    // First tick at or after the arrival of the next report that no tick has received.
    const std::int64_t due_ns = (last_ns / report_ns + 1) * report_ns;
    const std::int64_t now_ns = (due_ns + tick_ns - 1) / tick_ns * tick_ns;
    const auto held = static_cast<double>(now_ns - last_ns);
    total += held;
    squares += held * held;
    waited += held * static_cast<double>(last_wait_ns);
    last_ns = now_ns;
    last_wait_ns = now_ns % report_ns;
  }
  const double mean = total / kReportsLookedAt;
  const double variance = squares / kReportsLookedAt - mean * mean;
  // If every tick has its own report, the period remains exactly that of the rate.
  if (mean != static_cast<double>(tick_ns)) times.period = mean / 1e9;
  // A smaller variance, relative to the period, is rounding.
  if (variance > 1e-12 * mean * mean) times.period_spread = std::sqrt(variance) / 1e9;
  times.delay += waited / total / 1e9;
  return times;
}

driver::EnergyGuardSettings energy_settings(const ArmFile& arm, double rate,
                                            std::optional<driver::EnergyStage> scene) {
  const EnergyChoice& choice = arm.energy;
  const LoopTimes times = loop_pace(arm, rate);
  driver::EnergyGuardSettings settings;
  settings.stage = scene.value_or(choice.stage);
  settings.mass = choice.mass.value_or(arm.simulated.plant.mass);
  settings.allowance = choice.allowance.value_or(kEnergyAllowance);
  settings.reservoir = choice.reservoir.value_or(arm.declared.force * arm.declared.force /
                                                 (2 * arm.declared.stiffness));
  settings.onset = kEnergyOnset;
  settings.dissipation = arm.simulated.plant.viscous + kSureHandDamping;
  // One encoder step changes the velocity estimate by its gain times step over period.
  const double corner = 2 * std::numbers::pi * arm.velocity_corner_frequency;
  const double updates = 1 / times.period;
  const double gain = corner > 0 ? -math::expm1(-corner / updates) : 1;
  settings.speed_floor = gain * updates * worst_over_workspace(arm, 3).encoder_step;
  settings.slope =
      choice.slope.value_or(stiffness_limit(arm.simulated.plant.viscous, latency_of(times)));
  // Only a ring buffer of torques depends on the delay. A longer delay uses its last entry.
  settings.delay_ticks = static_cast<int>(
      std::min(std::round(times.delay * rate), double{driver::EnergyGuardSettings::kDelayMax}));
  return settings;
}

}  // namespace thimble::scene
