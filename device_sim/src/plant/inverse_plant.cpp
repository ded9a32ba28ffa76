#include "plant/inverse_plant.h"

#include <algorithm>
#include <cmath>

namespace thimble::device_sim {
namespace {

constexpr double kDifference = 1e-6;  // m

}  // namespace

template <class Geometry>
driver::Result<InversePlant<Geometry>> InversePlant<Geometry>::make(
    const driver::JointModel<Geometry>& model, const PlantSettings& plant, const HandSettings& hand,
    const MotorSettings& motors, const Eigen::Vector3d& p_BT, const Eigen::Vector3d& p_BH) {
  const auto dynamics = AxisDynamics::make(plant, hand);
  if (!dynamics) return dynamics.error();
  if (!(motors.current_max > 0 && motors.current_max < HUGE_VAL)) {
    return driver::Error{"The simulated arm's current_max must be finite and above zero (A)."};
  }
  const auto q = model.geometry.inverse(p_BT);
  if (!q) {
    return driver::Error{
        "The simulated arm cannot reach its starting point. Start the hand's path inside the arm's "
        "workspace."};
  }
  InversePlant made(model, *dynamics, motors.current_max, p_BT, p_BH, *q);
  if (!made.torque_per_ampere_.allFinite()) {
    return driver::Error{
        "The simulated arm's motor drives must be finite numbers: sign, ratio and torque constant "
        "of each joint."};
  }
  return made;
}

template <class Geometry>
InversePlant<Geometry>::InversePlant(const driver::JointModel<Geometry>& model,
                                     const AxisDynamics& dynamics, double current_max,
                                     const Eigen::Vector3d& p_BT, const Eigen::Vector3d& p_BH,
                                     const Eigen::Vector3d& q) noexcept
    : model_(model),
      current_max_(current_max),
      dynamics_(dynamics),
      axes_{AxisState{p_BT.x(), 0}, AxisState{p_BT.y(), 0}, AxisState{p_BT.z(), 0}},
      p_BH_(p_BH),
      q_(q) {
  for (int i = 0; i < 3; ++i) {
    const driver::MotorDrive& drive = model.drives[static_cast<std::size_t>(i)];
    torque_per_ampere_[i] = drive.sign * drive.ratio * drive.torque_constant;
  }
}

template <class Geometry>
void InversePlant<Geometry>::set_currents(const Eigen::Vector3d& amperes) noexcept {
  for (int i = 0; i < 3; ++i) {
    const double wanted = std::isnan(amperes[i]) ? 0.0 : amperes[i];
    amperes_[i] = std::clamp(wanted, -current_max_, current_max_);
  }
}

template <class Geometry>
Eigen::Vector3d InversePlant<Geometry>::f_T_B() const noexcept {
  const Eigen::Vector3d tau = torque_per_ampere_.cwiseProduct(amperes_);
  Eigen::Vector3d force(0, 0, 0);
  if (tau.isZero(0)) return force;
  const int axes = driver::motor_count(model_.geometry);
  for (int axis = 0; axis < axes; ++axis) {
    const Eigen::Vector3d step = kDifference * Eigen::Vector3d::Unit(axis);
    const auto ahead = model_.geometry.inverse(p_BT() + step);
    const auto behind = model_.geometry.inverse(p_BT() - step);
    if (!ahead || !behind) return {0, 0, 0};  // at the end of reach the stop carries the whole load
    force[axis] = (*ahead - *behind).dot(tau) / (2 * kDifference);
  }
  return force;
}

template <class Geometry>
void InversePlant<Geometry>::step(const Eigen::Vector3d& p_BH, std::int64_t dt_ns) noexcept {
  if (!(dt_ns > 0)) return;
  const Eigen::Vector3d force = f_T_B() + pull_B_;
  const Eigen::Vector3d v_BH = (p_BH - p_BH_) / (static_cast<double>(dt_ns) * 1e-9);
  const std::array<AxisState, 3> before = axes_;
  for (int i = 0; i < 3; ++i) {
    dynamics_.step(axes_[static_cast<std::size_t>(i)],
                   {.force = force[i], .anchor = p_BH_[i], .anchor_speed = v_BH[i]}, dt_ns);
  }
  p_BH_ = p_BH;
  if (const auto q = model_.geometry.inverse(p_BT())) {
    q_ = *q;
    return;
  }
  ++stops_;
  axes_ = before;
  for (AxisState& axis : axes_) axis.v = 0;
}

template class InversePlant<driver::DeltaArm>;
template class InversePlant<driver::LinkageArm>;
template class InversePlant<BoardGeometry>;

}  // namespace thimble::device_sim
