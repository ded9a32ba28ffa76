#include "thimble/driver/energy_guard.h"

#include <algorithm>

namespace thimble::driver {

void PassivityObserver::book(double work) noexcept {
  energy_ = std::min(energy_ - work, settings_.reservoir);
}

Eigen::Vector3d PassivityObserver::damping(const Eigen::Vector3d& v_WT, double dt) const noexcept {
  const double debt = -(energy_ + settings_.allowance);
  const double paid_per_damping = v_WT.squaredNorm() * dt;
  if (!(debt > 0) || !(paid_per_damping > 0)) return {0, 0, 0};
  const double most = settings_.mass / (dt * (1 + 2 * settings_.delay_ticks)) *
                      (debt < settings_.onset ? debt / settings_.onset : 1);
  return -std::min(debt / paid_per_damping, most) * v_WT;
}

double bounded_force(const EnergyFlow& flow, double slope) noexcept {
  return (flow.f_sent_W - slope * flow.move_W).norm();
}

}  // namespace thimble::driver
