#include "thimble/driver/device.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace thimble::driver {
namespace {

bool is_limit(double value) noexcept {
  return value > 0 && value < HUGE_VAL;
}

}  // namespace

Result<void> DeviceSettings::check() const {
  const auto wrong = [](const char* what, const char* least = "above zero") {
    return Error{std::string("The arm's ") + what + " must be a finite number " + least +
                 "; set it in the arm file."};
  };
  const auto loose = [](const char* what, const char* bound) {
    return Error{std::string("The arm's ") + what + " protects nobody as it is set: it must be " +
                 bound + "; set it in the arm file."};
  };
  if (!is_limit(limits.force_max)) return wrong("force_max");
  if (!is_limit(limits.speed_max)) return wrong("speed_max");
  if (!is_limit(limits.rise_max)) return wrong("rise_max");
  if (!is_limit(limits.soft_start)) return wrong("soft_start");
  if (!is_limit(limits.reopen)) return wrong("reopen time");
  if (limits.soft_start < GateLimits::kSoftStartLeast)
    return loose("soft_start", "at least 0.05 s");
  if (limits.rise_max >
      std::max(GateLimits::kRiseMost, limits.force_max / GateLimits::kRiseTimeLeast))
    return loose("rise_max", "at most 100,000 N/s");
  if (limits.stall_ns <= 0) return wrong("stall time");
  if (limits.watchdog_ns <= 0) return wrong("watchdog time");
  if (limits.watchdog_ns > GateLimits::kWatchdogMost_ns)
    return loose("watchdog time", "at most 1 s");
  if (!(limits.power_max >= 0 && limits.power_max < HUGE_VAL)) {
    return wrong("power_max", "of zero or more");
  }
  if (limits.power_max > 0 && !is_limit(limits.power_time)) return wrong("power_time");
  if (silence_limit_ns <= 0) return wrong("silence limit");
  if (!is_limit(motion.hold_most)) return wrong("hold_unchanged time");
  for (std::size_t i = 0; heat.named() && i < 3; ++i) {
    if (!is_limit(heat.continuous_current[i])) return wrong("continuous_current");
    if (!is_limit(heat.time_constant[i])) return wrong("thermal_time_constant");
  }

  if (energy.stage == EnergyStage::kPassivity) {
    if (!is_limit(energy.mass)) return wrong("tip mass, which its passivity stage needs,");
    if (!is_limit(energy.reservoir)) return wrong("energy reservoir");
    if (!(energy.allowance >= 0)) return wrong("energy allowance", "of zero or more");
    if (!(energy.dissipation >= 0 && energy.dissipation < HUGE_VAL)) {
      return wrong("sure damping", "of zero or more");
    }
    if (!(energy.speed_floor >= 0 && energy.speed_floor < HUGE_VAL)) {
      return wrong("speed floor", "of zero or more");
    }
  }
  if (energy.stage == EnergyStage::kBounding && !is_limit(energy.slope)) {
    return wrong("slope of the energy bound");
  }
  if (energy.delay_ticks < 0 || energy.delay_ticks > EnergyGuardSettings::kDelayMost) {
    return Error{"The energy stage of the gate knows delays of 0 to 15 ticks; the loop's is " +
                 std::to_string(energy.delay_ticks) + "."};
  }
  return {};
}

}  // namespace thimble::driver
