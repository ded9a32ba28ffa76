#include "bringup/identify/link_inertia/masses_per_pose.h"

#include <fmt/format.h>

#include <Eigen/LU>

#include "bringup/identify/record_motion.h"
#include "plant/link_mechanics.h"

namespace thimble::bringup {

std::vector<PoseMass> pose_masses(const LinkFit& fit, const scene::ArmFile& file) {
  std::vector<PoseMass> all;
  for (const LinkFit::Place& place : fit.places) {
    PoseMass one;
    one.p_W = file.p_WB + file.R_WB * fit.arm.forward(place.q);
    one.mass = fit.apparent_mass(place.q);
    for (std::size_t i = 0; i < 3; ++i) {
      const double mass = one.mass[i].value;
      one.seen[i] = {mass * place.seen[i].value, mass * place.seen[i].plus_minus};
    }
    all.push_back(one);
  }
  return all;
}

std::array<double, 3> named_masses(const scene::ArmFile& file, const Eigen::Vector3d& q) {
  const auto& arm = std::get<driver::SerialArm>(file.model.geometry);
  const Eigen::Matrix3d G = arm.jacobian(q).inverse();
  const device_sim::LinkMechanics links(arm, file.simulated.links);
  const Eigen::Matrix3d M = G.transpose() * links.at(q, Eigen::Vector3d::Zero()).inertia * G;
  const double tip = file.simulated.plant.mass;
  return {tip + M(0, 0), tip + M(1, 1), tip + M(2, 2)};
}

MassRange mass_range(const LinkFit& fit, const scene::ArmFile& file) {
  constexpr int kSteps = 8;
  MassRange range;
  bool first = true;
  const Eigen::Vector3d step = (file.workspace.max_W - file.workspace.min_W) / kSteps;
  for (int i = 0; i < (kSteps + 1) * (kSteps + 1) * (kSteps + 1); ++i) {
    const Eigen::Vector3d count(i % (kSteps + 1), i / (kSteps + 1) % (kSteps + 1),
                                i / ((kSteps + 1) * (kSteps + 1)));
    const Eigen::Vector3d p_W = file.workspace.min_W + step.cwiseProduct(count);
    if (!moves_easily(file, p_W)) continue;
    const auto q = fit.arm.inverse(file.R_WB.transpose() * (p_W - file.p_WB));
    if (!q) continue;
    for (const Estimate& mass : fit.apparent_mass(*q)) {
      if (first || mass.value < range.min_mass.value) range.min_mass = mass;
      if (first || mass.value > range.max_mass.value) range.max_mass = mass;
      first = false;
    }
  }
  return range;
}

std::string pose_table(const LinkFit& fit, const scene::ArmFile& file) {
  std::string text =
      "Apparent mass along x, y and z of the base, g, at each place of the tip (world, mm):\n";
  for (const PoseMass& place : pose_masses(fit, file)) {
    text += fmt::format("  {:>5.0f} {:>5.0f} {:>5.0f}  ", 1e3 * place.p_W.x(), 1e3 * place.p_W.y(),
                        1e3 * place.p_W.z());
    for (const Estimate& mass : place.mass) {
      text += fmt::format("  {:>8.5g} +- {:<6.2g}", 1e3 * mass.value, 1e3 * mass.plus_minus);
    }
    text += '\n';
  }
  return text + range_text(fit, file) + "\n";
}

std::string range_text(const LinkFit& fit, const scene::ArmFile& file) {
  const MassRange range = mass_range(fit, file);
  return fmt::format(
      "Over the part of the workspace where the arm moves easily: {:.5g} +- {:.2g} to {:.5g} +- "
      "{:.2g} g.",
      1e3 * range.min_mass.value, 1e3 * range.min_mass.plus_minus, 1e3 * range.max_mass.value,
      1e3 * range.max_mass.plus_minus);
}

}  // namespace thimble::bringup
