#include "hand/hand.h"

#include <cmath>

#include "math/elementary.h"

namespace thimble::device_sim {

Eigen::Vector3d Hand::at(std::int64_t time_ns) noexcept {
  last_ns_ = time_ns;
  const std::int64_t own_ns = own_time_ns(time_ns);
  const Eigen::Vector3d tremor = tremor_.at(own_ns);
  if (!led_) return path_.at(static_cast<double>(own_ns - begin_ns_) * 1e-9) + tremor;
  if (own_ns > led_ns_) approach(static_cast<double>(own_ns - led_ns_) * 1e-9);
  led_ns_ = own_ns;
  return p_BH_ + tremor;
}

void Hand::lead(const Eigen::Vector3d& p_BG) noexcept {
  if (!p_BG.allFinite()) return;
  p_BG_ = p_BG;
  if (led_) return;
  led_ns_ = own_time_ns(last_ns_);
  p_BH_ = path_.at(static_cast<double>(led_ns_ - begin_ns_) * 1e-9);
  v_BH_.setZero();
  led_ = true;
}

void Hand::hold(bool still) noexcept {
  if (still == held_) return;
  if (still) {
    held_at_ns_ = last_ns_;
  } else {
    held_ns_ += last_ns_ - held_at_ns_;
  }
  held_ = still;
}

/// Critically damped spring, by its exact map. Its stretch is limited to 2 kSpeedMax / kQuickness.
/// So its pull, per mass, is at most 2 kQuickness kSpeedMax, which the damper (2 kQuickness)
/// balances at kSpeedMax: from rest, no speed exceeds it.
void Hand::approach(double dt) noexcept {
  Eigen::Vector3d x = p_BH_ - p_BG_;
  const double far = x.norm();
  constexpr double kFarMax = 2 * kSpeedMax / kQuickness;
  if (far > kFarMax) x *= kFarMax / far;
  const Eigen::Vector3d p_BG = p_BH_ - x;
  const Eigen::Vector3d a = v_BH_ + kQuickness * x;
  const double fade = math::exp(-kQuickness * dt);
  p_BH_ = p_BG + fade * (x + dt * a);
  v_BH_ = fade * (v_BH_ - kQuickness * dt * a);
}

}  // namespace thimble::device_sim
