#include "energy_guard_settings.h"
#include "motion_watch_settings.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {
namespace {

driver::WallSettings walls_around(const WorkspaceBox& box) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(driver::WallSettings::kMargin);
  driver::WallSettings walls;
  walls.min_W = box.min_W - margin;
  walls.max_W = box.max_W + margin;
  return walls;
}

}  // namespace

driver::DeviceSettings device_settings(const ArmFile& arm, double rate,
                                       std::optional<driver::EnergyStage> stage) {
  return {.R_WB = arm.R_WB,
          .p_WB = arm.p_WB,
          .limits = arm.limits,
          .energy = energy_settings(arm, rate, stage),
          .motion = motion_settings(arm, rate),
          .heat = arm.heat,
          .velocity_corner_frequency = arm.velocity_corner_frequency,
          .walls = walls_around(arm.workspace)};
}

}  // namespace thimble::scene
