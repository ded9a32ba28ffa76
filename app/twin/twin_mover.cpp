#include "twin/twin_mover.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "axis_dynamics.h"

namespace thimble::app {
namespace {

/// How recorded ticks reach the motors: within a tick the older currents last for the delay's
/// fraction.
struct TwinDelay {
  std::size_t whole = 0;  // ticks
  std::int64_t part_ns = 0, rest_ns = 0;

  TwinDelay(const scene::ArmFile& file, double dt) {
    const auto& wire = file.simulated.wire;
    const auto tick_ns = static_cast<std::int64_t>(std::llround(1e9 * dt));
    const std::int64_t delay_ns = wire.delay_in_ns + wire.delay_out_ns;
    whole = static_cast<std::size_t>(delay_ns / tick_ns);
    part_ns = delay_ns % tick_ns;
    rest_ns = tick_ns - part_ns;
  }
};

/// What an arm's motors make of recorded currents.
struct TwinMotors {
  Eigen::Vector3d torque_per_ampere;  // N m/A at the joints
  double current_max;                 // A
  device_sim::WiringSettings wiring;

  explicit TwinMotors(const scene::ArmFile& file)
      : current_max(file.simulated.motors.current_max), wiring(file.simulated.firmware.wiring) {
    for (int i = 0; i < 3; ++i) {
      const driver::MotorDrive& drive = file.model.drives[static_cast<std::size_t>(i)];
      torque_per_ampere[i] = drive.sign * drive.ratio * drive.torque_constant;
    }
  }

  Eigen::Vector3d torque(const Eigen::Vector3d& amperes) const {
    const Eigen::Vector3d flowing =
        wiring.motors(amperes).cwiseMax(-current_max).cwiseMin(current_max);
    return torque_per_ampere.cwiseProduct(flowing);
  }
};

/// A rigid arm: the tip is a mass with friction, which each axis of the simulated arm moves exactly
/// (device_sim/axis_dynamics.h). The joints' pull is taken where the recorded tip was, from which a
/// twin is some micrometres away at the most.
class RigidTwin final : public TwinMover {
 public:
  RigidTwin(const TwinMotion& motion, const scene::ArmFile& file,
            const device_sim::AxisDynamics& dynamics)
      : motion_(motion), delay_(file, motion.dt), dynamics_(dynamics) {
    const TwinMotors motors(file);
    for (const auto& stretch : motion.stretches) {
      std::vector<Pull> pulls(stretch.size());
      for (std::size_t k = delay_.whole + 1; k + 1 < stretch.size(); ++k) {
        // Half-way, as the plant has it.
        const Eigen::Matrix3d G = 0.5 * (stretch[k].G + stretch[k + 1].G);
        const auto pull = [&](std::size_t late) -> Eigen::Vector3d {
          return G.transpose() * motors.torque(stretch[k - late].amperes) + file.simulated.weight_B;
        };
        pulls[k] = {.older = pull(delay_.whole + 1), .newer = pull(delay_.whole)};
      }
      pulls_.push_back(std::move(pulls));
    }
  }

  void move(std::size_t stretch, std::size_t begin, const TwinStart& start,
            std::span<Eigen::Vector3d> seen) override {
    const std::vector<Pull>& pulls = pulls_[stretch];
    for (int axis = 0; axis < 3; ++axis) {
      device_sim::AxisState state{start.p_BT[axis], start.v_BT[axis]};
      seen[0][axis] = state.x;
      for (std::size_t j = 1; j < seen.size(); ++j) {
        const Pull& pull = pulls[begin + j - 1];
        dynamics_.step(state, {.force = pull.older[axis]}, delay_.part_ns);
        dynamics_.step(state, {.force = pull.newer[axis]}, delay_.rest_ns);
        seen[j][axis] = state.x;
      }
    }
  }

 private:
  /// On the tip during a tick, weight and all, N.
  struct Pull {
    Eigen::Vector3d older{0, 0, 0}, newer{0, 0, 0};
  };

  const TwinMotion& motion_;
  TwinDelay delay_;
  device_sim::AxisDynamics dynamics_;
  std::vector<std::vector<Pull>> pulls_;  // of each stretch, tick by tick
};

}  // namespace

driver::Result<std::unique_ptr<TwinMover>> make_twin_mover(const TwinMotion& motion,
                                                           const scene::ArmFile& file) {
  if (file.simulated.drive_train.named()) {
    return driver::Error{
        "The arm file names a drive train (simulation.drive_train), of which there is no twin yet; "
        "take that section out of a copy."};
  }
  const auto dynamics = device_sim::AxisDynamics::make(file.simulated.plant, {});
  if (!dynamics) return dynamics.error();
  return std::unique_ptr<TwinMover>(std::make_unique<RigidTwin>(motion, file, *dynamics));
}

}  // namespace thimble::app
