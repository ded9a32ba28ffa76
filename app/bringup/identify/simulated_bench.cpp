#include "bringup/identify/simulated_bench.h"

#include "bringup/identify/arm_constants.h"
#include "gravity_terms.h"

namespace thimble::bringup {

driver::Result<std::unique_ptr<BenchArm>> simulated_bench(const scene::ArmFile& file,
                                                          double added_mass, bool hold_it,
                                                          double max_force) {
  scene::ArmFile bench = file;
  if (!hold_it) bench.simulated.hand = {};
  bench.simulated.hand.mass += added_mass;
  bench.simulated.weight_B +=
      file.R_WB.transpose() * Eigen::Vector3d(0, 0, -scene::kGravity * added_mass);
  // No hand supports the mass until it is carried.
  if (added_mass > 0) bench.limits.soft_start = driver::GateLimits::kSoftStartMin;
  const Eigen::Vector3d middle = file.workspace.middle();
  return BenchArm::open(bench, {}, {}, {{0, middle}}, max_force);
}

}  // namespace thimble::bringup
