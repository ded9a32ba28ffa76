#include "plant/arm_plant.h"

#include <algorithm>
#include <cmath>

namespace thimble::device_sim {
namespace {

bool is_positive(double value) {
  return value > 0 && value < HUGE_VAL;
}

}  // namespace

driver::Result<ArmPlant> ArmPlant::make(const driver::SerialArm& arm,
                                        const std::array<driver::MotorDrive, 3>& drives,
                                        const PlantSettings& plant, const HandSettings& hand,
                                        const MotorSettings& motors, const Eigen::Vector3d& p_BT,
                                        const Eigen::Vector3d& p_BH) {
  const auto dynamics = AxisDynamics::make(plant, hand);
  if (!dynamics) return dynamics.error();
  if (!(is_positive(arm.length_b) && is_positive(arm.length_c) && std::isfinite(arm.height))) {
    return driver::Error{
        "The simulated arm's links must have finite lengths above zero (m). Set them in its "
        "geometry."};
  }
  if (!is_positive(motors.current_max)) {
    return driver::Error{"The simulated arm's current_max must be finite and above zero (A)."};
  }
  ArmPlant made(arm, drives, *dynamics, motors.current_max, p_BT, p_BH);
  if (!made.torque_per_ampere_.allFinite()) {
    return driver::Error{
        "The simulated arm's motor drives must be finite numbers: sign, ratio and torque constant "
        "of each joint."};
  }
  if (!made.pose_.within_reach()) {
    return driver::Error{
        "The simulated arm cannot reach its starting point. Start the hand's path inside the arm's "
        "workspace."};
  }
  return made;
}

ArmPlant::ArmPlant(const driver::SerialArm& arm, const std::array<driver::MotorDrive, 3>& drives,
                   const AxisDynamics& dynamics, double current_max, const Eigen::Vector3d& p_BT,
                   const Eigen::Vector3d& p_BH) noexcept
    : arm_(arm),
      current_max_(current_max),
      dynamics_(dynamics),
      axes_{AxisState{p_BT.x(), 0}, AxisState{p_BT.y(), 0}, AxisState{p_BT.z(), 0}},
      pose_(arm, p_BT),
      pose_near_(pose_),
      q_near_(pose_.angles()),
      p_BH_(p_BH) {
  for (int i = 0; i < 3; ++i) {
    const driver::MotorDrive& drive = drives[static_cast<std::size_t>(i)];
    torque_per_ampere_[i] = drive.sign * drive.ratio * drive.torque_constant;
  }
}

void ArmPlant::set_currents(const Eigen::Vector3d& amperes) noexcept {
  for (int i = 0; i < 3; ++i) {
    const double wanted = std::isnan(amperes[i]) ? 0.0 : amperes[i];
    amperes_[i] = std::clamp(wanted, -current_max_, current_max_);
    tau_[i] = torque_per_ampere_[i] * amperes_[i];
  }
  driven_ = !tau_.isZero(0);
}

SerialPose ArmPlant::pose_after(double time) const noexcept {
  const Eigen::Vector3d v = v_BT();
  if (v.isZero(0)) return pose_;
  return {arm_, p_BT() + v * time};
}

Eigen::Vector3d ArmPlant::q_about() noexcept {
  Eigen::Vector3d q;
  if (!pose_.angles_near(pose_near_, q_near_, q)) {
    pose_near_ = pose_;
    q = q_near_ = pose_.angles();
  }
  return q;
}

void ArmPlant::step(const Eigen::Vector3d& p_BH, std::int64_t dt_ns) noexcept {
  if (!(dt_ns > 0)) return;
  const double dt = static_cast<double>(dt_ns) * 1e-9;
  if (driven_) {
    const SerialPose half_way = pose_after(0.5 * dt);
    f_T_B_ = (half_way.within_reach() ? half_way : pose_).force_from(tau_);
  } else {
    f_T_B_.setZero();
  }
  const Eigen::Vector3d v_BH = (p_BH - p_BH_) * (1 / dt);
  const std::array<AxisState, 3> before = axes_;
  for (int i = 0; i < 3; ++i) {
    dynamics_.step(axes_[static_cast<std::size_t>(i)],
                   {.force = f_T_B_[i] + pull_B_[i], .anchor = p_BH_[i], .anchor_speed = v_BH[i]},
                   dt_ns);
  }
  p_BH_ = p_BH;
  const SerialPose after(arm_, p_BT());
  if (after.within_reach()) {
    pose_ = after;
    return;
  }
  ++stops_;
  axes_ = before;
  for (AxisState& axis : axes_) axis.v = 0;
}

}  // namespace thimble::device_sim
