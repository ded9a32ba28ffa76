#include "twin/twin_constants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace thimble::twin {
namespace {

constexpr double kPart = 0.02;  // of a constant: the step of a difference
// Sine of the slope above which weight moves the tip [chosen: far above rounding errors].
constexpr double kTilted = 1e-6;

/// Downward direction of the world in the base, as far as the tip can move along it.
Eigen::Vector3d down_B(const scene::ArmFile& file) {
  const Eigen::Vector3d down = file.R_WB.transpose() * Eigen::Vector3d(0, 0, -1);
  return down.cwiseProduct(driver::free_axes(file.motors()));
}

/// One number of each joint of the drive train.
struct JointConstant {
  const char* key;
  const char* unit;
  Eigen::Vector3d device_sim::DriveTrainSettings::*member;
};

/// Adds motors and cables, which motion shows if the cables are elastic, else the friction of
/// joints; and the currents' lag.
void add_drive_train(const scene::ArmFile& file, std::vector<TwinConstant>& all) {
  using device_sim::DriveTrainSettings;
  const DriveTrainSettings& train = file.simulated.drive_train;
  if (train.current_lag > 0) {
    all.push_back(
        {.key = "simulation.drive_train.current_lag",
         .unit = "s",
         .step = 0.1 * train.current_lag,
         .min_value = 0,
         .get = [](const scene::ArmFile& arm) { return arm.simulated.drive_train.current_lag; },
         .set = [](scene::ArmFile& arm,
                   double to) { arm.simulated.drive_train.current_lag = to; }});
  }
  static constexpr JointConstant kOfCables[] = {
      {"stiffness", "N m/rad", &DriveTrainSettings::stiffness},
      {"inertia", "kg m^2", &DriveTrainSettings::inertia},
      {"damping", "N m s/rad", &DriveTrainSettings::damping},
  };
  static constexpr JointConstant kOfJoints[] = {
      {"coulomb", "N m", &DriveTrainSettings::coulomb},
      {"viscous", "N m s/rad", &DriveTrainSettings::viscous},
  };
  const bool soft = train.compliant();
  for (const JointConstant& one : soft ? std::span<const JointConstant>(kOfCables) : kOfJoints) {
    for (Eigen::Index i = 0; i < file.motors(); ++i) {
      const double value = (train.*one.member)[i];
      if (!(value > 0)) continue;
      all.push_back(
          {.key = fmt::format("simulation.drive_train.{}[{}]", one.key, i + 1),
           .unit = one.unit,
           .step = kPart * value,
           .min_value = 0.1 * value,
           .get = [member = one.member,
                   i](const scene::ArmFile& arm) { return (arm.simulated.drive_train.*member)[i]; },
           .set = [member = one.member, i](
                      scene::ArmFile& arm,
                      double to) { (arm.simulated.drive_train.*member)[i] = to; }});
    }
  }
}

}  // namespace

std::vector<TwinConstant> twin_constants(const scene::ArmFile& file) {
  const auto& plant = file.simulated.plant;
  std::vector<TwinConstant> all;
  all.push_back({.key = "simulation.tip.mass",
                 .unit = "kg",
                 .step = kPart * plant.mass,
                 .min_value = 0.1 * plant.mass,
                 .get = [](const scene::ArmFile& arm) { return arm.simulated.plant.mass; },
                 .set = [](scene::ArmFile& arm, double to) { arm.simulated.plant.mass = to; }});
  all.push_back({.key = "simulation.tip.viscous",
                 .unit = "N s/m",
                 .step = std::max(0.1 * plant.viscous, 1e-4),
                 .min_value = 0,
                 .get = [](const scene::ArmFile& arm) { return arm.simulated.plant.viscous; },
                 .set = [](scene::ArmFile& arm, double to) { arm.simulated.plant.viscous = to; }});
  all.push_back({.key = "simulation.tip.coulomb",
                 .unit = "N",
                 .step = std::max(kPart * plant.coulomb, 1e-4),
                 .min_value = 0,
                 .get = [](const scene::ArmFile& arm) { return arm.simulated.plant.coulomb; },
                 .set = [](scene::ArmFile& arm, double to) { arm.simulated.plant.coulomb = to; }});
  // A plane or a line that is level carries the weight.
  if (down_B(file).norm() > kTilted) {
    all.push_back(
        {.key = "simulation.tip.weight",
         .unit = "N",
         .step = 1e-3,
         .min_value = 0,
         .get =
             [](const scene::ArmFile& arm) {
               const Eigen::Vector3d down = down_B(arm);
               return arm.simulated.weight_B.dot(down) / down.squaredNorm();
             },
         .set = [](scene::ArmFile& arm, double to) { arm.simulated.weight_B = to * down_B(arm); }});
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(file.motors()); ++i) {
    const double torque_constant = file.model.drives[i].torque_constant;
    all.push_back(
        {.key = fmt::format("joints.torque_constant[{}]", i + 1),
         .unit = "N m/A",
         .step = kPart * torque_constant,
         .min_value = 0,
         .get = [i](const scene::ArmFile& arm) { return arm.model.drives[i].torque_constant; },
         .set = [i](scene::ArmFile& arm, double to) { arm.model.drives[i].torque_constant = to; }});
  }
  // Motion only shows the sum of both delays.
  all.push_back({.key = "simulation.wire.delay_in + delay_out",
                 .unit = "s",
                 .step = 5e-5,
                 .min_value = 0,
                 .get =
                     [](const scene::ArmFile& arm) {
                       const auto& wire = arm.simulated.wire;
                       return 1e-9 * static_cast<double>(wire.delay_in_ns + wire.delay_out_ns);
                     },
                 .set =
                     [](scene::ArmFile& arm, double to) {
                       auto& wire = arm.simulated.wire;
                       const auto sum_ns = static_cast<std::int64_t>(std::llround(1e9 * to));
                       wire.delay_in_ns = std::min(wire.delay_in_ns, sum_ns);
                       wire.delay_out_ns = sum_ns - wire.delay_in_ns;
                     }});
  add_drive_train(file, all);
  return all;
}

}  // namespace thimble::twin
