#include "thimble/driver/heat_guard.h"

#include <algorithm>
#include <cmath>

#include "math/elementary.h"

namespace thimble::driver {
namespace {

// A message holds integer mA, rounded: a current may exceed the requested one by this much, A.
constexpr double kRounding = 0.0005;

// Returns a heat up to which `limit` allows `share` times the continuous current, by its own
// formula and with a margin for its rounding; -1 if there is none.
double heat_of_full_current(double share, double slope) noexcept {
  constexpr double kRoom = 1 + 1e-9;
  return slope > 0 ? 1 - (share * share * kRoom - 1) / slope : -1;
}

}  // namespace

// Proof that the heat never exceeds 1. The max. squared load at heat h is u(h) = 1 + s (1 - h).
// Held for dt it leaves 1 - h' = (1 - h) (1 - g (1 + s)) with g = 1 - exp(-dt / tau), which is not
// negative as long as g (1 + s) <= 1. The slope s is the smaller of two: the one for which the
// current begins to fall at kWarning, and the one that this inequality allows at the longest hold.
HeatGuard::HeatGuard(const HeatSettings& settings, const std::array<MotorDrive, 3>& drives,
                     double longest_hold) noexcept
    : settings_(settings), drives_(drives), named_(settings.named()), heat_(settings.at_start) {
  if (!named_) return;
  for (std::size_t i = 0; i < 3; ++i) {
    current_max_[i] = drives[i].current_max;
    const double peak = current_max_[i] / settings.continuous_current[i];
    const double fall = std::max(0.0, (peak * peak - 1) / (1 - kWarning));
    const double hold = -math::expm1(-longest_hold / settings.time_constant[i]);
    slope_[i] = std::min(fall, 1 / hold - 1);
    cool_[i] = heat_of_full_current((current_max_[i] + kRounding) / settings.continuous_current[i],
                                    slope_[i]);
    // An invalid heat counts as the limit.
    if (!(heat_[i] >= 0 && heat_[i] <= 1)) heat_[i] = 1;
    max_heat_ = std::max(max_heat_, heat_[i]);
  }
  limit();
}

void HeatGuard::advance(double dt) noexcept {
  if (!(dt > 0 && dt < HUGE_VAL)) return;
  if (dt != gain_dt_) {
    gain_dt_ = dt;
    for (std::size_t i = 0; i < 3; ++i) gain_[i] = -math::expm1(-dt / settings_.time_constant[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    heat_[i] += gain_[i] * (load_[i] - heat_[i]);
    max_heat_ = std::max(max_heat_, heat_[i]);
  }
  limit();
}

void HeatGuard::sent(const std::array<std::int16_t, 3>& mA, bool scaled) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = 1e-3 * mA[i] / settings_.continuous_current[i];
    load_[i] = share * share;
  }
  if (scaled && limiting_) ++lowered_;
}

void HeatGuard::limit() noexcept {
  limiting_ = false;
  for (std::size_t i = 0; i < 3; ++i) {
    // The usual case, which needs no square root.
    if (heat_[i] <= cool_[i]) {
      drives_[i].current_max = current_max_[i];
      continue;
    }
    const double load = 1 + slope_[i] * (1 - heat_[i]);
    // Written so that NaN allows no current.
    const double most =
        load > 0 ? settings_.continuous_current[i] * std::sqrt(load) - kRounding : 0;
    drives_[i].current_max = most > 0 ? std::min(most, current_max_[i]) : 0;
    limiting_ = limiting_ || drives_[i].current_max < current_max_[i];
  }
}

}  // namespace thimble::driver
