#include "studies/stability/drive_train_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>

#include "stability/signal.h"
#include "studies/stability/stability_picture_parts.h"

namespace thimble::studies {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kCellRange =
    4;  // an edge is searched between the map's value divided and multiplied by this

/// A joint that alone moves the tip along a line at home.
struct LoneJoint {
  stability::ArmDirection direction;
  Matrix3d J_BT;  // at home, m/rad
};

std::optional<LoneJoint> lone_joint(const scene::ArmFile& arm) {
  constexpr double kAlone = 1e-6;  // cosine
  Vector3d p_BT;
  Matrix3d J;
  const Vector3d q = arm.model.joint_angles({});
  std::visit([&](const auto& build) { build.forward(q, p_BT, J); }, arm.model.geometry);
  for (int i = 0; i < 3; ++i) {
    const Vector3d n = J.col(i).normalized();
    const double others =
        std::max(std::abs(n.dot(J.col((i + 1) % 3))), std::abs(n.dot(J.col((i + 2) % 3))));
    if (!(others < kAlone * J.col(i).norm())) continue;
    const auto direction = stability::direction_at_home(arm, arm.R_WB * n);
    if (direction) return LoneJoint{*direction, J};
  }
  return std::nullopt;
}

std::vector<double> series(double min, double max, int count, bool logarithmic) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    values.push_back(logarithmic ? min * std::pow(max / min, share) : min + (max - min) * share);
  }
  return values;
}

/// Returns whether an oscillation after a kick grows. It uses the force: if a motor oscillates
/// against its tip, the tip moves little.
driver::Result<bool> force_grows(const scene::ArmFile& arm, stability::WallCase wall, double mass) {
  constexpr double kStartForce = 0.3;  // N, far above a step of the current
  constexpr double kFarFromStart = 10;
  constexpr double kFarthest = 0.05;  // m
  const double frequency = std::sqrt(wall.stiffness / mass);
  wall.kick = kStartForce / wall.stiffness * frequency;
  wall.give_up = kFarthest;
  const auto run = stability::run_wall(arm, wall);
  if (!run) return run.error();
  if (run->gave_up) return true;
  // The fast oscillation of the motor against the tip may grow while the slow one decays.
  const double rate = 1e9 / static_cast<double>(wall.period_ns);
  const double between = 2 * frequency / (2 * std::numbers::pi);
  const std::vector<double> quick =
      stability::high_passed(run->push, rate, std::min(between, 0.3 * rate));
  const auto grown = [&](const std::vector<double>& force) {
    const auto max = [&](double from, double to) {
      const auto at = [&](double share) {
        return force.begin() +
               static_cast<std::ptrdiff_t>(share * static_cast<double>(force.size()));
      };
      const auto [min, largest] = std::minmax_element(at(from), at(to));
      return std::max(*largest, -*min);
    };
    // After early growth up to the motors' limit, it cannot grow further.
    if (max(0.3, 1) > kFarFromStart * kStartForce) return true;
    return max(0.75, 1) > std::max(max(0.3, 0.55), 2 * wall.direction.force_step);
  };
  return grown(run->push) || grown(quick);
}

}  // namespace

void add_drive_train_walls(const StabilitySetup& setup, std::vector<StabilityCell>& cells) {
  for (const double lag : series(0, 0.003, setup.coarse ? 3 : 13, false)) {
    cells.push_back({.part = StabilityPart::kLagEdge, .a = lag});
  }
  if (!lone_joint(setup.arm)) return;
  const auto dampings = setup.coarse ? std::vector<double>{0.3, 3} : std::vector<double>{0.3, 1, 3};
  for (const double damping : dampings) {
    for (const double stiffness : series(1e3, 1e6, setup.coarse ? 4 : 19, true)) {
      cells.push_back({.part = StabilityPart::kCableEdge, .a = stiffness, .b = damping});
    }
  }
}

stability::SampledWall drive_train_wall(const StabilitySetup& setup, const StabilityCell& cell) {
  stability::SampledWall wall{
      .mass = setup.arm.simulated.plant.mass, .viscous = kBareDamping, .period = setup.period()};
  if (cell.part == StabilityPart::kLagEdge) {
    wall.amplifier_lag = cell.a;
    return wall;
  }
  wall.rotor_mass = kRotorShare * wall.mass;
  wall.mass -= wall.rotor_mass;
  wall.cable_stiffness = cell.a;
  wall.cable_damping = cell.b;
  return wall;
}

driver::Result<double> drive_train_edge(const StabilitySetup& setup, const StabilityCell& cell) {
  const stability::SampledWall linear = drive_train_wall(setup, cell);
  scene::ArmFile arm = setup.arm;
  auto& train = arm.simulated.drive_train;
  train = {};
  stability::WallCase wall;
  wall.direction = setup.direction;
  wall.tip = {.mass = linear.mass, .viscous = linear.viscous, .coulomb = 0};
  wall.period_ns = setup.period_ns;
  wall.duration = 2;
  if (cell.part == StabilityPart::kLagEdge) {
    train.current_lag = cell.a;
  } else {
    const auto joint = lone_joint(arm);
    if (!joint)
      return driver::Error{arm.name + ": no joint moves the tip in a direction of its own."};
    wall.direction = joint->direction;
    for (int i = 0; i < 3; ++i) {
      const double lever2 = joint->J_BT.col(i).squaredNorm();
      train.stiffness[i] = linear.cable_stiffness * lever2;
      train.damping[i] = linear.cable_damping * lever2;
      train.inertia[i] = linear.rotor_mass * lever2;
    }
  }
  const double about = stability::stiffness_edge(linear);
  double low = about / kCellRange, high = about * kCellRange;
  while (high > 1.002 * low) {
    wall.stiffness = std::sqrt(low * high);
    const auto grows = force_grows(arm, wall, linear.mass + linear.rotor_mass);
    if (!grows) return grows.error();
    (*grows ? high : low) = wall.stiffness;
  }
  return std::sqrt(low * high);
}

driver::Result<void> draw_drive_train_walls(const StabilitySetup& setup,
                                            const std::vector<StabilityRow>& rows,
                                            const std::filesystem::path& folder) {
  std::vector<std::vector<double>> lags, lag_law, cables, cable_law;
  for (const StabilityRow& row : part_of(rows, StabilityPart::kLagEdge)) {
    lags.push_back({1e3 * row.cell.a, row.found[0]});
  }
  for (const double lag : series(0, 0.003, 61, false)) {
    const stability::SampledWall wall =
        drive_train_wall(setup, {.part = StabilityPart::kLagEdge, .a = lag});
    lag_law.push_back(
        {1e3 * lag, stability::limit_by_phase(wall), stability::stiffness_edge(wall)});
  }
  std::vector<double> dampings;
  for (const StabilityRow& row : part_of(rows, StabilityPart::kCableEdge)) {
    if (dampings.empty() || dampings.back() != row.cell.b) {
      if (!dampings.empty()) cables.push_back({});
      dampings.push_back(row.cell.b);
    }
    cables.push_back({1e-3 * row.cell.a, row.found[0]});
  }
  for (const double damping : dampings) {
    if (!cable_law.empty()) cable_law.push_back({});
    for (const double stiffness : series(1e3, 1e6, 121, true)) {
      const stability::SampledWall wall = drive_train_wall(
          setup, {.part = StabilityPart::kCableEdge, .a = stiffness, .b = damping});
      cable_law.push_back(
          {1e-3 * stiffness, stability::limit_by_phase(wall), stability::stiffness_edge(wall)});
    }
  }
  for (const auto& [data, file] : {std::pair(&lags, "by_lag.dat"),
                                   {&lag_law, "by_lag_law.dat"},
                                   {&cables, "by_cable.dat"},
                                   {&cable_law, "by_cable_law.dat"}}) {
    if (auto done = write_data(*data, folder / "data" / file); !done) return done;
  }
  const auto sweep = [](const std::string& file, std::size_t block, const char* ink,
                        const std::string& title) {
    const std::string part = " every :::" + std::to_string(block) + "::" + std::to_string(block);
    return "'data/" + file + "_law.dat'" + part + " using 1:3 with lines lw 1.5 dt 2 lc rgb '" +
           report::kInk + "' notitle, 'data/" + file + "_law.dat'" + part +
           " using 1:2 with lines lw 2.5 lc rgb '" + ink + "' title " + report::quote(title) +
           ", 'data/" + file + ".dat'" + part + " using 1:2 with points pt 7 ps 1 lc rgb '" + ink +
           "' notitle";
  };
  constexpr std::array kInks{report::kForceInk, report::kDepthInk, kGreenInk};
  std::ostringstream c;
  c << report::quiet_style() << "set multiplot\n"
    << heading("Largest stable stiffness of a wall with a drive train",
               "free linear arm, b = 1 N s/m; lines: the law; dots: the simulated loop; dashed: "
               "exact map of one tick; " +
                   setup.arm.name)
    << "set key top right samplen 2 spacing 1.2 font ',15' textcolor rgb '" << report::kInk << "'\n"
    << panel(0.085, 0.475, 0.14, 0.79) << panel_title("Lag of the amplifiers")
    << axis_labels("time constant of the current [ms]", "largest stiffness [N/m]")
    << "set xrange [-0.1:3.1]\nset yrange [0:*]\nplot " << sweep("by_lag", 0, report::kForceInk, "")
    << "\nunset label 101\nunset label 102\n";
  if (!dampings.empty()) {
    c << panel(0.565, 0.975, 0.14, 0.79)
      << panel_title("Cable stiffness: the motor has 30 % of the mass")
      << axis_labels("stiffness of the cable at the tip [N/mm]", "")
      << "set logscale x\nset xrange [0.8:1250]\nset xtics (1, 3, 10, 30, 100, 300, 1000)\nplot ";
    for (std::size_t i = 0; i < dampings.size(); ++i) {
      c << (i > 0 ? ", " : "")
        << sweep("by_cable", i, kInks[i % kInks.size()],
                 fmt::format("damping of the cable {:g} N s/m", dampings[i]));
    }
    c << "\n";
  }
  c << "unset multiplot\n";
  return report::draw_plot({"drive_train", 1600, 800, c.str()}, folder);
}

}  // namespace thimble::studies
