#include "thimble/scene/arm_file.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "arm_table.h"
#include "energy_guard_settings.h"
#include "gravity_terms.h"
#include "nanoseconds.h"
#include "read_scene.h"
#include "simulation_section.h"
#include "thimble/scene/arm_policy.h"
#include "thimble/scene/shipped_files.h"
#include "wire_section.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {
namespace {

// The bounds below are not limits of any arm. They are far beyond what a desk-top arm can have
// [DEVICES 3], so that a misplaced decimal point or a value in mm is reported with its line.
constexpr std::int64_t kCountsMax = 1'000'000;

driver::SerialArm read_geometry(YamlMap map) {
  driver::SerialArm geometry;
  geometry.height = map.require_number("height", "m", -1, 1);
  geometry.length_b = map.require_number("length_b", "m", 0.01, 1);
  geometry.length_c = map.require_number("length_c", "m", 0.01, 1);
  map.finish();
  return geometry;
}

driver::PaddleArm read_paddle(YamlMap map) {
  driver::PaddleArm geometry;
  geometry.handle = map.require_number("handle", "m", 0.01, 1);
  map.finish();
  return geometry;
}

driver::FiveBarArm read_five_bar(YamlMap map) {
  driver::FiveBarArm geometry;
  geometry.base = map.require_number("base", "m", 0, 1);
  geometry.crank_1 = map.require_number("crank_1", "m", 0.01, 1);
  geometry.crank_2 = geometry.crank_1;
  if (map.has("crank_2")) geometry.crank_2 = map.require_number("crank_2", "m", 0.01, 1);
  geometry.distal_1 = map.require_number("distal_1", "m", 0.01, 1);
  geometry.distal_2 = geometry.distal_1;
  if (map.has("distal_2")) geometry.distal_2 = map.require_number("distal_2", "m", 0.01, 1);
  map.finish();
  return geometry;
}

driver::CartesianArm read_cartesian(YamlMap map) {
  driver::CartesianArm geometry;
  const std::size_t axes = map.list_size("radius");
  geometry.axes = static_cast<int>(axes >= 1 && axes <= 3 ? axes : 3);
  map.set_motors(geometry.axes);
  geometry.radius = map.require_vector3("radius", "m", 1e-4, 1);
  for (int axis = 0; axis < 3; ++axis) {
    if (axis >= geometry.axes || !(geometry.radius[axis] > 0)) geometry.radius[axis] = 1;
  }
  map.finish();
  return geometry;
}

/// Reads the geometry of a shape that is not built in.
driver::ArmGeometry read_geometry(YamlMap map, std::string_view shape) {
  if (shape == "paddle") return read_paddle(std::move(map));
  if (shape == "five_bar") return read_five_bar(std::move(map));
  if (shape == "cartesian") return read_cartesian(std::move(map));
  return read_geometry(std::move(map));
}

/// Reads the thermal limits of the motors: both keys or none.
driver::HeatSettings read_heat(YamlMap& map) {
  driver::HeatSettings heat;
  const bool current = map.has("continuous_current"), time = map.has("thermal_time_constant");
  if (!current && !time) return heat;
  if (!current) map.refuse("thermal_time_constant", "needs continuous_current in the same section");
  if (!time) map.refuse("continuous_current", "needs thermal_time_constant in the same section");
  if (!current || !time) return heat;
  const Eigen::Vector3d amperes = map.require_vector3("continuous_current", "A", 0.01, 32);
  const Eigen::Vector3d seconds = map.require_vector3("thermal_time_constant", "s", 1, 1e5);
  for (std::size_t i = 0; i < 3; ++i) {
    heat.continuous_current[i] = amperes[static_cast<Eigen::Index>(i)];
    heat.time_constant[i] = seconds[static_cast<Eigen::Index>(i)];
  }
  return heat;
}

/// Returns the sentence for a key whose value a built-in shape fixes.
std::string fixed_by(const driver::ShapeRow& shape) {
  return "is fixed by shape: " + std::string(shape.name) + "; remove it";
}

/// Reads the values that may differ between two arms of a built-in shape, whose geometry, drives
/// and encoders are code.
void read_built_in_joints(YamlMap map, const driver::ShapeRow& shape, driver::ArmModel& model,
                          driver::HeatSettings& heat) {
  for (const char* key : {"ratio", "current_max", "counts_per_motor_turn", "home_counts",
                          "motor_sign", "encoder_sign"}) {
    map.explain_unused(key, fixed_by(shape));
  }
  Eigen::Vector3d torque;
  for (std::size_t i = 0; i < 3; ++i) {
    torque[static_cast<Eigen::Index>(i)] = model.drives[i].torque_constant;
  }
  torque = map.optional_vector3("torque_constant", torque, "N m/A", 1e-4, 10);
  for (std::size_t i = 0; i < 3; ++i) {
    model.drives[i].torque_constant = torque[static_cast<Eigen::Index>(i)];
  }
  heat = read_heat(map);
  map.finish();
}

void read_joints(YamlMap map, driver::ArmModel& model, driver::HeatSettings& heat) {
  const int motors = driver::motor_count(model.geometry);
  map.set_motors(motors);
  const Eigen::Vector3d ratio = map.require_vector3("ratio", "motor turns per joint turn", 1, 1000);
  const Eigen::Vector3d torque = map.require_vector3("torque_constant", "N m/A", 1e-4, 10);
  const Eigen::Vector3d current = map.require_vector3("current_max", "A", 0.01, 32);
  const auto counts = map.require_three_whole("counts_per_motor_turn", "counts", 1, kCountsMax);
  const auto home = map.require_three_whole("home_counts", "counts", -kCountsMax, kCountsMax);
  const auto motor_sign = map.require_signs("motor_sign");
  const auto encoder_sign = map.require_signs("encoder_sign");
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    model.drives[i] = {static_cast<double>(motor_sign[i]), ratio[k], torque[k], current[k]};
    model.encoders[i] = {static_cast<double>(encoder_sign[i]), static_cast<double>(counts[i]),
                         home[i]};
    if (k < motors) continue;
    model.drives[i] = driver::absent_motor();
    model.encoders[i] = driver::absent_encoder();
  }
  heat = read_heat(map);
  for (auto i = static_cast<std::size_t>(motors); i < 3; ++i) {
    heat.continuous_current[i] = heat.continuous_current[0];
    heat.time_constant[i] = heat.time_constant[0];
  }
  map.finish();
}

/// Reads the gimbal that is mounted on this arm.
driver::Gimbal read_gimbal(YamlMap map) {
  driver::Gimbal gimbal;
  const auto counts = map.require_three_whole("counts_per_turn", "counts", 4, kCountsMax);
  const auto home =
      map.optional_three_whole("home_counts", {0, 0, 0}, "counts", -kCountsMax, kCountsMax);
  const auto sign = map.require_signs("sign");
  const auto axes = map.optional_choices("axes", {0, 1, 0}, {"x", "y", "z"});
  if (axes.size() == 3) {
    if (axes[0] == axes[1] || axes[1] == axes[2]) {
      map.refuse("axes", "expected different axes for neighbours");
    }
  } else if (!axes.empty()) {  // an unreadable value is already reported
    map.refuse("axes", "expected three axes, from the link to the stylus");
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (axes.size() == 3) gimbal.axes[i] = static_cast<driver::FrameAxis>(axes[i]);
    gimbal.sign[i] = static_cast<double>(sign[i]);
    gimbal.counts_per_turn[i] = static_cast<double>(counts[i]);
    gimbal.home_counts[i] = static_cast<std::int32_t>(home[i]);
  }
  map.finish();
  return gimbal;
}

std::optional<double> optional_value(YamlMap& map, std::string_view key, std::string_view unit,
                                     double min, double max) {
  if (!map.has(key)) return {};
  return map.require_number(key, unit, min, max);
}

/// Default of the mean power on the hand, W, and of the averaging time, s [chosen: 1 W moves a
/// pinch grip of 3 N s/m (PHYSICS 0) at 0.6 m/s permanently; within 2 s it is the work of 5 N over
/// 0.4 m, so that no constant force within an arm's workspace is reduced].
constexpr double kPowerMax = 1, kPowerTime = 2;

driver::GateLimits read_gate(YamlMap map, ArmFile& arm) {
  driver::GateLimits limits;
  limits.force_max = map.require_number("force_max", "N", 0.01, 100);
  limits.speed_max = map.require_number("speed_max", "m/s", 0.01, 20);
  limits.rise_max = map.require_number("rise_max", "N/s", 1, driver::GateLimits::kRiseMax);
  limits.soft_start = map.require_number("soft_start", "s", driver::GateLimits::kSoftStartMin, 10);
  limits.stall_ns = to_ns(map.require_number("stall", "s", 0.001, 10));
  limits.watchdog_ns =
      to_ns(map.require_number("watchdog", "s", 0.001, 1e-9 * driver::GateLimits::kWatchdogMax_ns));
  limits.reopen = map.optional_number("reopen", limits.reopen, "s", 0.001, 10);
  limits.power_max = map.optional_number("power_max", kPowerMax, "W", 0.01, 20);
  limits.power_time = map.optional_number("power_time", kPowerTime, "s", 0.1, 10);
  if (limits.force_max > arm.declared.force) {
    map.reject("force_max",
               fmt::format("expected at most the declared force of the arm, {:g} N, found {:g}",
                           arm.declared.force, limits.force_max));
  }
  if (arm.wire) {
    const double own = arm.wire->text.watchdog;
    if (own == 0 && limits.force_max > kFeelCheckForceMax) {
      map.reject("force_max",
                 fmt::format("expected at most {:g} N, because the board has no watchdog (wire, "
                             "watchdog: 0): when the program stops, the motors keep the last force",
                             kFeelCheckForceMax));
    }
    if (own > 0 && limits.watchdog_ns > to_ns(own)) {
      map.reject("watchdog", fmt::format("expected at most the time of the board's own watchdog, "
                                         "{:g} s (wire, watchdog)",
                                         own));
    }
  }
  // If one of them is invalid, it is already reported and has its smallest value.
  if (limits.stall_ns >= limits.watchdog_ns && limits.watchdog_ns > to_ns(0.001)) {
    map.reject("stall", "expected a shorter time than watchdog");
  }
  EnergyChoice& energy = arm.energy;
  if (map.has("energy")) {
    energy.stage =
        static_cast<driver::EnergyStage>(map.require_choice("energy", kEnergyStageNames));
  }
  arm.hold_unchanged = optional_value(map, "hold_unchanged", "s", 0.05, 600);
  energy.mass = optional_value(map, "tip_mass", "kg", 1e-3, 10);
  energy.allowance = optional_value(map, "energy_allowance", "J", 0, 1);
  energy.reservoir = optional_value(map, "energy_reservoir", "J", 1e-6, 10);
  energy.slope = optional_value(map, "energy_slope", "N/m", 0.1, 1e6);
  for (const char* key :
       {"force_max", "speed_max", "rise_max", "soft_start", "stall", "watchdog", "reopen", "energy",
        "power_max", "power_time", "tip_mass", "energy_allowance", "energy_reservoir",
        "energy_slope", "hold_unchanged"}) {
    arm.gate_lines[key] = map.key_line(key);
  }
  map.finish();
  return limits;
}

/// Reads the place of the line or plane in which the tip of an arm with one or two motors moves:
/// the position of the base, and the direction of the world of each of its axes.
void read_axes_place(YamlMap map, ArmFile& arm) {
  const int motors = arm.motors();
  arm.p_WB = map.require_vector3("position", "m", -2, 2);
  constexpr std::array<std::string_view, 6> kDirections{"x", "y", "z", "-x", "-y", "-z"};
  const auto along = map.optional_choices(
      "along", motors == 1 ? std::vector<std::size_t>{2} : std::vector<std::size_t>{1, 2},
      {kDirections.begin(), kDirections.end()});
  map.finish();
  if (along.empty()) return;  // the mistake is already reported
  if (along.size() != static_cast<std::size_t>(motors)) {
    map.refuse("along", motors == 1 ? "expected one direction, that of the arm's line"
                                    : "expected two directions, those of the arm's x and y axes");
    return;
  }
  const auto direction = [](std::size_t choice) {
    const double sign = choice < 3 ? 1 : -1;
    return Eigen::Vector3d(sign * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(choice % 3)));
  };
  const Eigen::Vector3d x = direction(along.front());
  const Eigen::Vector3d y = direction(motors == 1 ? (along.front() + 1) % 3 : along.back());
  if (x.cross(y).isZero(0)) {
    map.refuse("along", "expected two directions at right angles");
    return;
  }
  arm.R_WB << x, y, x.cross(y);
}

/// Narrows the workspace of an arm with one or two motors to its line or plane, if that is along
/// the axes of the world. Returns false if the box does not contain any of it.
bool narrow_to_axes(WorkspaceBox& box, const ArmFile& arm) {
  for (int axis = arm.motors(); axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) {
      if (std::abs(arm.R_WB(k, axis)) != 1) continue;
      if (!(arm.p_WB[k] >= box.min_W[k] && arm.p_WB[k] <= box.max_W[k])) return false;
      box.min_W[k] = box.max_W[k] = arm.p_WB[k];
    }
  }
  return true;
}

/// Reads how the home pose is known. Precondition: the workspace is read.
HomePose read_home(YamlMap map, const ArmFile& arm) {
  HomePose home;
  home.how = static_cast<HomeMethod>(
      1 + map.require_choice("how", {kHomeMethods.begin(), kHomeMethods.end()}));
  if (map.has("check")) {
    home.check_p_WT = map.require_vector3("check", "m", -2, 2);
    if ((arm.on_axes(*home.check_p_WT) - *home.check_p_WT).norm() > 1e-6 ||
        !driver::inverse(arm.model.geometry,
                         arm.R_WB.transpose() * (*home.check_p_WT - arm.p_WB))) {
      map.reject("check", "expected a point that the tip can reach");
    }
  }
  home.within = map.optional_number("within", home.within, "m", 1e-4, 0.1);
  map.explain_unused("within", "needs check in the same section");
  map.finish();
  return home;
}

WorkspaceBox read_workspace(YamlMap map, const ArmFile& arm) {
  const Eigen::Vector3d min_W = map.require_vector3("min", "m", -2, 2);
  const Eigen::Vector3d max_W = map.require_vector3("max", "m", -2, 2);
  if (!(min_W.array() <= max_W.array()).all()) {
    map.reject("max", "expected no coordinate smaller than that of min");
  }
  map.finish();
  WorkspaceBox box{min_W, max_W};
  if (!narrow_to_axes(box, arm)) {
    map.reject("", "expected a box that contains a part of the line or plane of the arm's tip");
  }
  return box;
}

DeclaredLimits read_declared(YamlMap map) {
  DeclaredLimits declared;
  declared.force = map.require_number("force", "N", 0.01, 100);
  declared.stiffness = map.require_number("stiffness", "N/m", 1, 1e5);
  declared.damping = map.require_number("damping", "N s/m", 0, 1000);
  declared.continuous_force = map.optional_number("continuous_force", 0, "N", 0, 100);
  if (declared.continuous_force > declared.force) {
    map.reject("continuous_force", "expected at most the declared force");
  }
  map.finish();
  return declared;
}

/// Returns the largest compensation force of the motors over the workspace, N.
double max_carried(const ArmFile& arm) {
  if (arm.carried_moments.isZero(0)) return arm.carried_weight;
  constexpr int kPlaces = 5;  // number of points along each side of the workspace
  const LinkGravity links = link_gravity(arm);
  const Eigen::Vector3d side = (arm.workspace.max_W - arm.workspace.min_W) / (kPlaces - 1);
  double max_force = 0;
  for (int i = 0; i < kPlaces * kPlaces * kPlaces; ++i) {
    const Eigen::Vector3d at(i % kPlaces, i / kPlaces % kPlaces, i / (kPlaces * kPlaces));
    const Eigen::Vector3d p_WT = arm.workspace.min_W + side.cwiseProduct(at);
    const auto q = links.arm.inverse(arm.R_WB.transpose() * (p_WT - arm.p_WB));
    if (!q) continue;
    max_force =
        std::max(max_force, (links.carried(*q) + Eigen::Vector3d(0, 0, arm.carried_weight)).norm());
  }
  return max_force;
}

/// Reads how much of the weight of the arm its motors carry: at most a third of `force_max` of the
/// gate [chosen: so that most of the force is left for the scene]. If links need more in some
/// poses, they get that third there.
void read_carried(YamlMap map, ArmFile& arm) {
  const double third = arm.limits.force_max / 3;
  arm.carried_weight = map.optional_number("weight", 0, "N", 0, 10);
  if (arm.carried_weight > third) {
    map.reject("weight",
               fmt::format("expected at most a third of the gate's force_max, {:.3g} N", third));
  }
  for (const char* key : {"moment_b", "moment_c"})
    map.explain_unused(key, std::string(kNeedsSerialArm));
  if (arm.is<driver::SerialArm>()) {
    arm.carried_moments = {map.optional_number("moment_b", 0, "kg m", -1, 1),
                           map.optional_number("moment_c", 0, "kg m", -1, 1)};
  }
  if (!arm.carried_moments.isZero(0)) {
    LinkGravity links = link_gravity(arm);
    links.max_force = HUGE_VAL;
    const auto q = links.arm.inverse(arm.R_WB.transpose() * (arm.workspace.middle() - arm.p_WB));
    const double weight = q ? links.carried(*q).norm() + arm.carried_weight : 0;
    if (weight > third) {
      map.reject("",
                 fmt::format("expected a compensation of at most a third of the gate's "
                             "force_max, {:.3g} N, in the middle of the workspace, found {:.3g} N",
                             third, weight));
    }
  }
  map.finish();
  arm.max_carried_force = max_carried(arm);
}

std::vector<driver::BoardKind> read_boards(YamlMap& root, const driver::ArmRow& row) {
  const std::span<const driver::BoardKind> fitting(row.boards.data(), row.board_count);
  std::vector<driver::BoardKind> boards;
  for (const std::size_t index :
       root.optional_choices("board", {static_cast<std::size_t>(fitting.front())},
                             {driver::kBoardNames.begin(), driver::kBoardNames.end()})) {
    const auto board = static_cast<driver::BoardKind>(index);
    if (std::find(fitting.begin(), fitting.end(), board) == fitting.end()) {
      root.reject("board", "the board " + std::string(name(board)) + " does not use the protocol " +
                               std::string(row.protocol));
    }
    boards.push_back(board);
  }
  if (boards.empty()) boards.push_back(fitting.front());  // the mistake is already reported
  return boards;
}

/// Returns the shape of arms whose vendor software reports the position of the tip.
const driver::ShapeRow& vendor_pose_shape() {
  const auto shapes = driver::arm_shapes();
  return *std::find_if(shapes.begin(), shapes.end(), [](const driver::ShapeRow& row) {
    return row.built_in != nullptr &&
           std::holds_alternative<driver::VendorPoseArm>(row.built_in().geometry);
  });
}

/// Protocol of arms whose wire is described, and its row in the place of one of the table of arms.
constexpr std::string_view kDescribedProtocol = "described";
constexpr driver::ArmRow kDescribedRow{.kind = driver::ArmKind::kDescribed,
                                       .protocol = kDescribedProtocol};

/// Reads protocol and shape of the arm, by their names in the table of arms.
void read_kind(YamlMap& root, ArmFile& arm) {
  std::vector<std::string_view> protocols, shapes;
  for (const driver::ArmRow& row : driver::arm_table()) protocols.push_back(row.protocol);
  for (const driver::ShapeRow& row : driver::arm_shapes()) shapes.push_back(row.name);
  protocols.push_back(kDescribedProtocol);
  const std::size_t index = root.require_choice("protocol", protocols);
  const bool described = index == driver::arm_table().size();
  const driver::ArmRow row = described ? kDescribedRow : driver::arm_table()[index];
  arm.protocol = row.kind;
  if (described) {
    arm.boards = {driver::BoardKind::kDescribed};
    root.explain_unused("board", "is described by the section wire; remove it");
    arm.wire = read_wire(root.require_map("wire"));
  } else {
    arm.boards = read_boards(root, row);
    root.explain_unused("wire", "needs protocol: described");
  }
  if (!described && row.has_own_link()) {
    // The software of its vendor knows joints and motors. A file that contains them is rejected.
    arm.model = vendor_pose_shape().built_in();
    for (const char* key : {"shape", "board_model", "geometry", "joints", "gimbal"}) {
      root.explain_unused(key,
                          "cannot be used with an arm that a service or library of its vendor "
                          "drives");
    }
    return;
  }
  const driver::ShapeRow& shape = driver::arm_shapes()[root.optional_choice("shape", 0, shapes)];
  arm.board_model = static_cast<int>(root.optional_whole("board_model", 0, "", 0, 1000));
  if (shape.built_in != nullptr) {
    arm.model = shape.built_in();
    root.explain_unused("geometry", fixed_by(shape));
    if (root.has("joints")) {
      read_built_in_joints(root.require_map("joints"), shape, arm.model, arm.heat);
    }
  } else {
    arm.model.geometry = read_geometry(root.require_map("geometry"), shape.name);
    read_joints(root.require_map("joints"), arm.model, arm.heat);
  }
  if ((row.kind == driver::ArmKind::kFalcon) != arm.is<driver::DeltaArm>()) {
    root.reject("protocol", "expected falcon_packet with shape: falcon, and only with it");
  }
  if (arm.is<driver::VendorPoseArm>()) {
    root.reject("shape", "told is only for arms that a service or library of their vendor drives");
  }
  if (!root.has("gimbal")) return;
  if (!(arm.wire ? arm.wire->report.has(driver::WireItem::kGimbal) : row.carries_gimbal)) {
    root.reject("gimbal",
                "the reports of " + std::string(row.protocol) + " contain no gimbal encoders");
  }
  arm.model.gimbal = read_gimbal(root.require_map("gimbal"));
}

}  // namespace

driver::Result<ArmFile> load_arm(const std::filesystem::path& meant) {
  const auto file = find_arm_file(meant.string());
  if (!file) return file.error();
  driver::Result<YamlFile> yaml = YamlFile::load(*file);
  if (!yaml) return yaml.error();
  return read_arm(*yaml);
}

driver::Result<ArmFile> read_arm(YamlFile& yaml) {
  YamlMap& root = yaml.root();
  ArmFile arm;
  arm.name = root.require_string("name");
  arm.description = root.optional_string("description", "");
  read_kind(root, arm);
  if (arm.motors() < 3 && root.has("at")) {
    read_axes_place(root.require_map("at"), arm);
    root.explain_unused("base", "cannot be used with at, which has the position of the base");
  } else {
    root.explain_unused("at", "needs shape: paddle, five_bar or cartesian with one or two motors");
    YamlMap base = root.require_map("base");
    arm.p_WB = base.require_vector3("position", "m", -2, 2);
    arm.R_WB = base.optional_rotation("rotate_degrees");
    base.finish();
  }
  arm.workspace = read_workspace(root.require_map("workspace"), arm);
  if (root.has("home")) arm.home = read_home(root.require_map("home"), arm);
  arm.declared = read_declared(root.require_map("declared"));
  arm.limits = read_gate(root.require_map("gate"), arm);
  if (root.has("gravity_compensation")) {
    read_carried(root.require_map("gravity_compensation"), arm);
  }
  arm.velocity_corner_frequency = root.require_number("velocity_corner_frequency", "Hz", 0, 1e5);
  if (arm.is<driver::VendorPoseArm>() && root.has("simulation")) {
    root.refuse("simulation",
                "an arm that a service or library of its vendor drives cannot be simulated");
  }
  if (arm.is<driver::SerialArm>() || root.has("simulation")) {
    arm.simulated = read_simulation(root.require_map("simulation"), arm);
    arm.can_simulate = true;
  }
  root.finish();
  if (auto done = yaml.finish(); !done) return done.error();
  return arm;
}

}  // namespace thimble::scene
