#include "plant/drive_train_plant.h"

#include <algorithm>

namespace thimble::device_sim {

template <class Geometry, class Tip>
driver::Result<DriveTrainPlant<Geometry, Tip>> DriveTrainPlant<Geometry, Tip>::make(
    const driver::JointModel<Geometry>& model, const SimulatedArmSettings& settings,
    const Eigen::Vector3d& p_BT, const Eigen::Vector3d& p_BH, std::int64_t sub_step_ns) {
  const auto tip = Tip::make(model.geometry, settings, p_BT);
  if (!tip) return tip.error();
  const DriveTrainSettings& wanted = settings.drive_train;
  const auto train = DriveTrain::make(wanted, model.drives, settings.motors.current_max);
  if (!train) return train.error();
  if (!settings.weight_B.allFinite()) {
    return driver::Error{"The simulated arm's weight must be finite (N)."};
  }
  const auto pose = tip_pose(model.geometry, p_BT);
  if (!pose) {
    return driver::Error{
        "The simulated arm cannot reach its starting point. Start the hand's path inside the arm's "
        "workspace."};
  }
  const auto unused = AxisDynamics::make(settings.plant, {});  // without elastic cables
  if (!unused) return unused.error();
  std::array<AxisDynamics, 3> rotors{*unused, *unused, *unused};
  for (std::size_t i = 0; wanted.compliant() && i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const auto rotor = AxisDynamics::make(
        {.mass = wanted.inertia[k], .viscous = wanted.viscous[k], .coulomb = wanted.coulomb[k]},
        {});
    if (!rotor) return rotor.error();
    rotors[i] = *rotor;
  }
  return DriveTrainPlant(model, settings, *train, *tip, rotors, p_BH, *pose, sub_step_ns);
}

template <class Geometry, class Tip>
DriveTrainPlant<Geometry, Tip>::DriveTrainPlant(const driver::JointModel<Geometry>& model,
                                                const SimulatedArmSettings& settings,
                                                const DriveTrain& train, const Tip& tip,
                                                const std::array<AxisDynamics, 3>& rotors,
                                                const Eigen::Vector3d& p_BH, const TipPose& pose,
                                                std::int64_t sub_step_ns) noexcept
    : geometry_(model.geometry),
      weight_B_(settings.weight_B),
      compliant_(settings.drive_train.compliant()),
      train_(train),
      tip_(tip),
      rotor_dynamics_(rotors),
      rotor_{AxisState{pose.q[0], 0}, AxisState{pose.q[1], 0}, AxisState{pose.q[2], 0}},
      p_BH_(p_BH),
      sub_step_ns_(sub_step_ns) {}

template <class Geometry, class Tip>
void DriveTrainPlant<Geometry, Tip>::put(const DriveTrainState& state) noexcept {
  const auto pose = tip_pose(geometry_, state.p_BT);
  if (!pose) return;
  tip_.put(state.p_BT, state.v_BT);
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    rotor_[k] =
        compliant_ ? AxisState{state.q_rotor[i], state.rate_rotor[i]} : AxisState{pose->q[i], 0};
  }
  if (compliant_) rate_before_ = state.rate_rotor - pose->G * state.v_BT;
  train_.put(state.amperes);
}

/// Returns the torques in the cables half-way (N m at the joints). Rates are extrapolated to
/// half-way from the present and the previous sub-step.
template <class Geometry, class Tip>
Eigen::Vector3d DriveTrainPlant<Geometry, Tip>::cable_pull(const TipPose& half_way,
                                                           const Eigen::Vector3d& rotor) noexcept {
  const Eigen::Vector3d turned = rotor - half_way.q;
  const Eigen::Vector3d rate = rotor_rate() - half_way.G * v_BT();
  const Eigen::Vector3d rate_half_way = 1.5 * rate - 0.5 * rate_before_;
  rate_before_ = rate;
  return {train_.pull(0, turned[0], rate_half_way[0]), train_.pull(1, turned[1], rate_half_way[1]),
          train_.pull(2, turned[2], rate_half_way[2])};
}

template <class Geometry, class Tip>
void DriveTrainPlant<Geometry, Tip>::turn_rotors(const Eigen::Vector3d& motor,
                                                 const Eigen::Vector3d& cable,
                                                 std::int64_t dt_ns) noexcept {
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    rotor_dynamics_[k].step(rotor_[k], {.force = motor[i] - cable[i]}, dt_ns);
  }
}

template <class Geometry, class Tip>
void DriveTrainPlant<Geometry, Tip>::sub_step(const Eigen::Vector3d& v_BH,
                                              std::int64_t dt_ns) noexcept {
  const double dt = static_cast<double>(dt_ns) * 1e-9;
  const typename Tip::State before = tip_.state();
  auto half_way = tip_pose(geometry_, p_BT() + 0.5 * dt * v_BT());
  if (!half_way) half_way = tip_pose(geometry_, p_BT());
  if (half_way) {
    const Eigen::Vector3d rotor =
        compliant_ ? this->rotor() + 0.5 * dt * rotor_rate() : Eigen::Vector3d(half_way->q);
    const Eigen::Vector3d motor = train_.torque(train_.pass(dt), rotor);
    const Eigen::Vector3d cable = compliant_ ? cable_pull(*half_way, rotor) : motor;
    f_T_B_ = half_way->G.transpose() * cable;
    if (compliant_) turn_rotors(motor, cable, dt_ns);
  }
  const Eigen::Vector3d force = f_T_B_ + weight_B_;
  tip_.step(half_way, force, p_BH_, v_BH, dt_ns);
  p_BH_ += dt * v_BH;
  const auto after = tip_pose(geometry_, p_BT());
  if (!after) {
    ++stops_;
    tip_.stop_at(before);
  } else if (!compliant_) {
    for (int i = 0; i < 3; ++i) rotor_[static_cast<std::size_t>(i)].x = after->q[i];
  }
}

template <class Geometry, class Tip>
void DriveTrainPlant<Geometry, Tip>::step(const Eigen::Vector3d& p_BH,
                                          std::int64_t dt_ns) noexcept {
  if (!(dt_ns > 0)) return;
  const Eigen::Vector3d v_BH = (p_BH - p_BH_) * (1e9 / static_cast<double>(dt_ns));
  while (dt_ns > 0) {
    const std::int64_t sub_ns = std::min(dt_ns, sub_step_ns_);
    sub_step(v_BH, sub_ns);
    dt_ns -= sub_ns;
  }
  p_BH_ = p_BH;
}

template class DriveTrainPlant<driver::SerialArm, PointTip>;
template class DriveTrainPlant<driver::SerialArm, LinkedTip>;
template class DriveTrainPlant<driver::LinkageArm, PointTip>;
template class DriveTrainPlant<driver::LinkageArm, LinkedTip>;
template class DriveTrainPlant<BoardGeometry, PointTip>;
template class DriveTrainPlant<BoardGeometry, LinkedTip>;

}  // namespace thimble::device_sim
