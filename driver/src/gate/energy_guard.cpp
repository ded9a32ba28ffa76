#include "thimble/driver/energy_guard.h"

#include <algorithm>
#include <cmath>

namespace thimble::driver {
namespace {

/// More than any surface stores that a hand can press, J: 10 N over the workspace of an arm.
constexpr double kHeldMax = 2;

}  // namespace

void PassivityObserver::book(double work, double held) noexcept {
  // Written so that NaN and infinity store nothing.
  const double more = held > 0 && held < HUGE_VAL ? std::min(held, kHeldMax) : 0;
  energy_ = std::min(energy_ - work, settings_.reservoir + more);
}

void PassivityObserver::book(const EnergyFlow& flow) noexcept {
  const double given = flow.dissipated - flow.work;
  const double paid = flow.stored_change > 0 ? std::min(flow.stored_change, std::max(given, 0.0))
                                             : flow.stored_change;
  book(paid - given, flow.held);
}

double PassivityObserver::share(double dt) noexcept {
  if (!(settings_.onset > 0)) return 1;
  const double beyond = -energy_ - settings_.allowance - settings_.onset;
  if (beyond > 0) {
    share_ = std::min(share_, std::max(0.0, 1 - beyond / settings_.onset));
  } else if (beyond <= -settings_.onset / 2 && share_ < 1) {
    share_ = std::min(1.0, share_ + dt / kReturn);
  }
  return share_;
}

Eigen::Vector3d PassivityObserver::damping(const Eigen::Vector3d& v_WT, double dt) const noexcept {
  const double debt = -(energy_ + settings_.allowance);
  const double paid_per_damping = v_WT.squaredNorm() * dt;
  if (!(debt > 0) || !(paid_per_damping > 0)) return {0, 0, 0};
  const double most = settings_.mass / (dt * (1 + 2 * settings_.delay_ticks)) *
                      (debt < settings_.onset ? debt / settings_.onset : 1);
  const double felt = 1 - settings_.speed_floor / v_WT.norm();
  if (!(felt > 0)) return {0, 0, 0};
  return -std::min(debt / paid_per_damping, most) * felt * v_WT;
}

double bounded_force(const EnergyFlow& flow, double slope) noexcept {
  return (flow.f_sent_W - slope * flow.move_W).norm();
}

}  // namespace thimble::driver
