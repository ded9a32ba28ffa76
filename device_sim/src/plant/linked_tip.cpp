#include "plant/linked_tip.h"

#include <utility>

#include "plant/axis_dynamics.h"
#include "plant/dry_friction.h"

namespace thimble::device_sim {
driver::Result<LinkedTip> LinkedTip::make(const driver::SerialArm& arm,
                                          const SimulatedArmSettings& settings,
                                          const Eigen::Vector3d& p_BT) {
  if (auto good = check_links(settings.links); !good) return good.error();
  std::optional<LinkMechanics> links;
  if (settings.links.named()) links.emplace(arm, settings.links);
  return make_of(std::move(links), settings, p_BT);
}

driver::Result<LinkedTip> LinkedTip::make(const driver::LinkageArm&,
                                          const SimulatedArmSettings& settings,
                                          const Eigen::Vector3d& p_BT) {
  return make_of({}, settings, p_BT);
}

driver::Result<LinkedTip> LinkedTip::make(const BoardGeometry&,
                                          const SimulatedArmSettings& settings,
                                          const Eigen::Vector3d& p_BT) {
  return make_of({}, settings, p_BT);
}

driver::Result<LinkedTip> LinkedTip::make_of(std::optional<LinkMechanics> links,
                                             const SimulatedArmSettings& settings,
                                             const Eigen::Vector3d& p_BT) {
  if (const auto good = AxisDynamics::make(settings.plant, settings.hand); !good) {
    return good.error();
  }
  return LinkedTip(std::move(links), settings, p_BT);
}

LinkedTip::LinkedTip(std::optional<LinkMechanics> links, const SimulatedArmSettings& settings,
                     const Eigen::Vector3d& p_BT) noexcept
    : links_(std::move(links)),
      mass_(settings.plant.mass + settings.hand.mass),
      coulomb_(settings.plant.coulomb),
      viscous_(settings.plant.viscous + settings.hand.damping),
      hand_(settings.hand),
      state_{.p = p_BT} {
  // Behind an elastic cable, a joint's friction is its motor's.
  if (settings.drive_train.compliant()) return;
  joint_coulomb_ = settings.drive_train.coulomb;
  joint_viscous_ = settings.drive_train.viscous;
}

void LinkedTip::take(const AxisDynamics& tip) noexcept {
  mass_ = tip.mass();
  coulomb_ = tip.coulomb();
  viscous_ = tip.viscous();
  hand_.stiffness = tip.hand_stiffness();
  hand_.damping = tip.hand_damping();
}

void LinkedTip::step(const std::optional<TipPose>& half_way, const Eigen::Vector3d& force,
                     const Eigen::Vector3d& p_BH, const Eigen::Vector3d& v_BH,
                     std::int64_t dt_ns) noexcept {
  if (!half_way) return;
  const double dt = static_cast<double>(dt_ns) * 1e-9;
  const Eigen::Vector3d before = state_.v;
  const Eigen::Vector3d p = state_.p + 0.5 * dt * before;
  const Eigen::Matrix3d& G = half_way->G;
  Eigen::Vector3d f = force;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  if (links_) {
    const LinkMotion links = links_->at(half_way->q, G * (before + 0.5 * dt * acceleration_));
    inertia = G.transpose() * links.inertia * G;
    f = force + G.transpose() * links.torque + inertia * links.turning;
  }
  f = f + hand_.stiffness * (p_BH + 0.5 * dt * v_BH - p) + hand_.damping * v_BH;
  // Viscous friction and the hand's damper use the mean velocity.
  inertia.diagonal().array() += mass_ + 0.5 * dt * viscous_;
  Eigen::Vector3d drag = viscous_ * before;
  if (!joint_viscous_.isZero(0)) {
    const Eigen::Matrix3d of_joints = G.transpose() * joint_viscous_.asDiagonal() * G;
    inertia += 0.5 * dt * of_joints;
    drag += of_joints * before;
  }
  const Eigen::Vector3d momentum = inertia * before + dt * (f - drag);
  const DryFriction friction{.tip = dt * coulomb_, .joints = dt * joint_coulomb_, .G = G};
  state_.v = velocity_after_friction(inertia, momentum, friction, before);
  state_.p = p + 0.5 * dt * state_.v;
  acceleration_ = (state_.v - before) / dt;
}

}  // namespace thimble::device_sim
