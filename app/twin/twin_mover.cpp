#include "twin/twin_mover.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "plant/axis_dynamics.h"
#include "twin/drive_train_twin.h"
#include "twin/twin_motors.h"

namespace thimble::twin {
namespace {

/// A rigid arm: the tip is a mass with friction, which each axis of the simulated arm moves exactly
/// (plant/axis_dynamics.h). The joints' force is evaluated at the recorded tip, from which a twin
/// differs by some micrometres at most.
class RigidTwin final : public TwinMover {
 public:
  RigidTwin(const TwinMotion& motion, const scene::ArmFile& file,
            const device_sim::AxisDynamics& dynamics)
      : delay_(file, motion.dt), dynamics_(dynamics) {
    const TwinMotors motors(file);
    for (const auto& stretch : motion.stretches) {
      std::vector<Pull> pulls(stretch.size());
      for (std::size_t k = delay_.whole + 1; k + 1 < stretch.size(); ++k) {
        // Half-way, as in the plant.
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
  /// Force on the tip during a tick, including weight, N.
  struct Pull {
    Eigen::Vector3d older{0, 0, 0}, newer{0, 0, 0};
  };

  TwinDelay delay_;
  device_sim::AxisDynamics dynamics_;
  std::vector<std::vector<Pull>> pulls_;  // for each stretch, tick by tick
};

}  // namespace

driver::Result<std::unique_ptr<TwinMover>> make_twin_mover(const TwinMotion& motion,
                                                           const scene::ArmFile& file) {
  if (file.simulated.links.named()) {
    return driver::Error{
        "Twins of arms with simulation.links are not supported yet. Remove the section from a copy "
        "of the arm file and pass the copy with --arm."};
  }
  if (file.simulated.drive_train.named()) return make_drive_train_twin(motion, file);
  const auto dynamics = device_sim::AxisDynamics::make(file.simulated.plant, {});
  if (!dynamics) return dynamics.error();
  return std::unique_ptr<TwinMover>(std::make_unique<RigidTwin>(motion, file, *dynamics));
}

}  // namespace thimble::twin
