#include "thimble/driver/device.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/LU>

namespace thimble::driver {
namespace {

/// Max. distance of an arm from the world's origin, m [chosen: a room].
constexpr double kBaseMax = 10;

bool is_limit(double value) noexcept {
  return value > 0 && value < HUGE_VAL;
}

bool is_rotation(const Eigen::Matrix3d& R) {
  constexpr double kError = 1e-6;  // [chosen: the precision of numbers in a file]
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  // Written so that NaN is rejected; Eigen's maximum does not detect it.
  return R.allFinite() && off <= kError && R.determinant() > 0;
}

Result<void> check_walls(const WallSettings& walls) {
  // Written so that NaN is refused.
  if (!(walls.min_W.array() <= walls.max_W.array()).all()) {
    return Error{
        "The minimum of the arm's workspace must not exceed its maximum on any axis. Correct the "
        "workspace in the arm file."};
  }
  if (!(walls.stiffness >= 0 && walls.stiffness <= 1e4 && walls.damping >= 0 &&
        walls.damping <= 100 && walls.beyond >= 0 && walls.beyond < HUGE_VAL)) {
    return Error{
        "The walls of the arm's workspace need a stiffness from 0 to 10,000 N/m, a damping from 0 "
        "to 100 N s/m and a finite depth of zero or more."};
  }
  return {};
}

}  // namespace

Result<void> DeviceSettings::check() const {
  const auto wrong = [](const char* what, const char* least = "above zero") {
    return Error{std::string("The arm's ") + what + " must be a finite number " + least +
                 ". Set it in the arm file."};
  };
  const auto loose = [](const char* what, const char* bound) {
    return Error{std::string("The arm's ") + what +
                 " is too loose to protect a person. It must be " + bound +
                 ". Set it in the arm file."};
  };
  if (!is_limit(limits.force_max)) return wrong("force_max");
  if (!is_limit(limits.speed_max)) return wrong("speed_max");
  if (!is_limit(limits.rise_max)) return wrong("rise_max");
  if (!no_motors && limits.force_max > GateLimits::kForceMax) {
    return loose("force_max", "at most 100 N");
  }
  if (!no_motors && limits.speed_max > GateLimits::kSpeedMax) {
    return loose("speed_max", "at most 20 m/s");
  }
  if (!is_limit(limits.soft_start)) return wrong("soft_start");
  if (!is_limit(limits.reopen)) return wrong("reopen time");
  if (limits.soft_start < GateLimits::kSoftStartMin) return loose("soft_start", "at least 0.05 s");
  if (limits.rise_max > std::max(GateLimits::kRiseMax, limits.force_max / GateLimits::kRiseTimeMin))
    return loose("rise_max", "at most 100,000 N/s");
  if (limits.stall_ns <= 0) return wrong("stall time");
  if (limits.watchdog_ns <= 0) return wrong("watchdog time");
  if (limits.watchdog_ns > GateLimits::kWatchdogMax_ns)
    return loose("watchdog time", "at most 1 s");
  if (!(limits.power_max >= 0 && limits.power_max < HUGE_VAL)) {
    return wrong("power_max", "of zero or more");
  }
  if (limits.power_max > 0 && !is_limit(limits.power_time)) return wrong("power_time");
  if (silence_limit_ns <= 0) return wrong("silence limit");
  if (!(velocity_corner_frequency >= 0 && velocity_corner_frequency < HUGE_VAL)) {
    return wrong("velocity_corner_frequency", "of zero or more");
  }
  if (!is_rotation(R_WB)) {
    return Error{
        "R_WB of the device settings is not a rotation. Its columns must be orthonormal and "
        "right-handed, within 1e-6."};
  }
  if (!p_WB.allFinite() || !(p_WB.cwiseAbs().maxCoeff() <= kBaseMax)) {
    return Error{
        "p_WB of the device settings must be finite and within 10 m of the world's origin on each "
        "axis."};
  }
  if (auto checked = check_walls(walls); !checked) return checked;
  if (!is_limit(motion.max_hold)) return wrong("hold_unchanged time");
  for (std::size_t i = 0; heat.named() && i < 3; ++i) {
    if (!is_limit(heat.continuous_current[i])) return wrong("continuous_current");
    if (!is_limit(heat.time_constant[i])) return wrong("thermal_time_constant");
  }

  if (energy.stage == EnergyStage::kPassivity) {
    if (!is_limit(energy.mass)) return wrong("tip mass (required by the passivity stage)");
    if (!is_limit(energy.reservoir)) return wrong("energy reservoir");
    if (!(energy.allowance >= 0)) return wrong("energy allowance", "of zero or more");
    if (!(energy.dissipation >= 0 && energy.dissipation < HUGE_VAL)) {
      return wrong("guaranteed damping", "of zero or more");
    }
    if (!(energy.speed_floor >= 0 && energy.speed_floor < HUGE_VAL)) {
      return wrong("speed floor", "of zero or more");
    }
  }
  if (energy.stage == EnergyStage::kBounding && !is_limit(energy.slope)) {
    return wrong("slope of the energy bound");
  }
  if (energy.delay_ticks < 0 || energy.delay_ticks > EnergyGuardSettings::kDelayMax) {
    return Error{
        "The energy stage of the gate supports delays of 0 to 15 ticks; the delay of the loop is " +
        std::to_string(energy.delay_ticks) + "."};
  }
  return {};
}

}  // namespace thimble::driver
