#include "arm_policy/limits_policy.h"

#include <fmt/core.h>

#include <array>

#include "energy_guard_settings.h"
#include "thimble/driver/motion_watch.h"
#include "wires/wire_table.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

/// Value of the gate, and the direction in which it is tighter.
struct LimitRule {
  const char* key;
  const char* unit;
  bool less_is_tighter;
  double (*get)(const ArmFile&);
  void (*take)(ArmFile& to, const ArmFile& from);
};

/// Returns the allowance of the passivity stage that the gate would use, J.
double allowance_of(const ArmFile& arm) {
  return arm.energy.allowance.value_or(kEnergyAllowance);
}

/// Returns how long the driver would hold a force while no encoder counts, s.
double hold_of(const ArmFile& arm) {
  return arm.hold_unchanged.value_or(driver::MotionWatchSettings{}.max_hold);
}

constexpr std::array<LimitRule, 11> kRules{{
    {"force_max", "N", true, [](const ArmFile& arm) { return arm.limits.force_max; },
     [](ArmFile& to, const ArmFile& from) { to.limits.force_max = from.limits.force_max; }},
    {"speed_max", "m/s", true, [](const ArmFile& arm) { return arm.limits.speed_max; },
     [](ArmFile& to, const ArmFile& from) { to.limits.speed_max = from.limits.speed_max; }},
    {"rise_max", "N/s", true, [](const ArmFile& arm) { return arm.limits.rise_max; },
     [](ArmFile& to, const ArmFile& from) { to.limits.rise_max = from.limits.rise_max; }},
    {"soft_start", "s", false, [](const ArmFile& arm) { return arm.limits.soft_start; },
     [](ArmFile& to, const ArmFile& from) { to.limits.soft_start = from.limits.soft_start; }},
    {"reopen", "s", false, [](const ArmFile& arm) { return arm.limits.reopen; },
     [](ArmFile& to, const ArmFile& from) { to.limits.reopen = from.limits.reopen; }},
    {"stall", "s", true,
     [](const ArmFile& arm) { return 1e-9 * static_cast<double>(arm.limits.stall_ns); },
     [](ArmFile& to, const ArmFile& from) { to.limits.stall_ns = from.limits.stall_ns; }},
    {"watchdog", "s", true,
     [](const ArmFile& arm) { return 1e-9 * static_cast<double>(arm.limits.watchdog_ns); },
     [](ArmFile& to, const ArmFile& from) { to.limits.watchdog_ns = from.limits.watchdog_ns; }},
    {"power_max", "W", true, [](const ArmFile& arm) { return arm.limits.power_max; },
     [](ArmFile& to, const ArmFile& from) { to.limits.power_max = from.limits.power_max; }},
    {"power_time", "s", true, [](const ArmFile& arm) { return arm.limits.power_time; },
     [](ArmFile& to, const ArmFile& from) { to.limits.power_time = from.limits.power_time; }},
    {"energy_allowance", "J", true, allowance_of,
     [](ArmFile& to, const ArmFile& from) { to.energy.allowance = from.energy.allowance; }},
    {"hold_unchanged", "s", true, hold_of,
     [](ArmFile& to, const ArmFile& from) { to.hold_unchanged = from.hold_unchanged; }},
}};

int line_in(const ArmFile& arm, const char* key) {
  const auto found = arm.gate_lines.find(key);
  return found == arm.gate_lines.end() ? 0 : found->second;
}

/// Returns FILE:LINE, or FILE if the value is a default without a line.
std::string place(const fs::path& file, int line) {
  return file.string() + (line > 0 ? ":" + std::to_string(line) : "");
}

std::string_view stage_name(driver::EnergyStage stage) {
  return kEnergyStageNames[static_cast<std::size_t>(stage)];
}

}  // namespace

std::optional<std::string> tighten_energy(ArmFile& arm, const fs::path& arm_path,
                                          driver::EnergyStage wanted, const fs::path& scene_file,
                                          int line) {
  const driver::EnergyStage own = arm.energy.stage;
  if (wanted == own) return {};
  std::string sentence = place(scene_file, line);
  sentence += ": energy: ";
  sentence += stage_name(wanted);
  if (wanted > own) {
    arm.energy.stage = wanted;
    sentence += " is kept: it is stronger than the arm's ";
  } else {
    sentence += " is ignored on a real arm, which keeps its own ";
  }
  sentence += stage_name(own);
  return sentence + " (" + place(arm_path, line_in(arm, "energy")) + ").";
}

std::vector<std::string> tighten(ArmFile& arm, const fs::path& arm_path, const ArmFile& other,
                                 const fs::path& other_path) {
  std::vector<std::string> warnings;
  for (const LimitRule& rule : kRules) {
    const int line = line_in(other, rule.key);
    const double own = rule.get(arm);
    const double value = rule.get(other);
    if (line == 0 || value == own) continue;
    // Written so that NaN is ignored.
    const bool tighter = rule.less_is_tighter ? value < own : value > own;
    if (tighter) rule.take(arm, other);
    warnings.push_back(place(other_path, line) +
                       fmt::format(": {} {:g} {} is {} {:g} {} (", rule.key, value, rule.unit,
                                   tighter ? "kept: it is tighter than the arm's"
                                           : "ignored: it is less strict than the arm's",
                                   own, rule.unit) +
                       place(arm_path, line_in(arm, rule.key)) + ").");
  }
  if (const int line = line_in(other, "energy"); line > 0) {
    const auto energy = tighten_energy(arm, arm_path, other.energy.stage, other_path, line);
    if (energy) warnings.push_back(*energy);
  }
  const auto ignore = [&](const char* key, const std::optional<double>& own,
                          const std::optional<double>& value) {
    if (!value || value == own) return;
    warnings.push_back(place(other_path, line_in(other, key)) + ": " + key +
                       " is ignored: a real arm uses only that of its installed arm file (" +
                       place(arm_path, line_in(arm, key)) + ").");
  };
  ignore("tip_mass", arm.energy.mass, other.energy.mass);
  ignore("energy_reservoir", arm.energy.reservoir, other.energy.reservoir);
  ignore("energy_slope", arm.energy.slope, other.energy.slope);
  return warnings;
}

const char* differing_section(const ArmFile& one, const ArmFile& other) {
  const auto same_joints = [&] {
    for (std::size_t i = 0; i < 3; ++i) {
      const driver::MotorDrive &a = one.model.drives[i], &b = other.model.drives[i];
      const driver::JointEncoder &e = one.model.encoders[i], &f = other.model.encoders[i];
      if (a.sign != b.sign || a.ratio != b.ratio || a.torque_constant != b.torque_constant ||
          a.current_max != b.current_max || e.sign != f.sign ||
          e.counts_per_motor_turn != f.counts_per_motor_turn || e.home_counts != f.home_counts) {
        return false;
      }
    }
    return true;
  };
  if (one.protocol != other.protocol) return "protocol";
  if ((one.wire == nullptr) != (other.wire == nullptr) ||
      (one.wire && !(one.wire->text == other.wire->text))) {
    return "wire";
  }
  if (one.model.geometry.index() != other.model.geometry.index()) return "shape";
  if (one.board_model != other.board_model) return "board_model";
  if (one.is<driver::SerialArm>()) {
    const auto& a = std::get<driver::SerialArm>(one.model.geometry);
    const auto& b = std::get<driver::SerialArm>(other.model.geometry);
    if (a.height != b.height || a.length_b != b.length_b || a.length_c != b.length_c) {
      return "geometry";
    }
  }
  const auto same_as = [&]<class Geometry>(const Geometry& a) {
    if constexpr (requires { a == a; }) return a == std::get<Geometry>(other.model.geometry);
    return true;  // built into the program
  };
  if (!std::visit(same_as, one.model.geometry)) return "geometry";
  if (!same_joints()) return "joints";
  // Older arm files do not mention a gimbal. In that case the installed file decides.
  if (other.model.gimbal && one.model.gimbal != other.model.gimbal) return "gimbal";
  if (one.R_WB != other.R_WB || one.p_WB != other.p_WB) return "base";
  if (one.workspace.min_W != other.workspace.min_W ||
      one.workspace.max_W != other.workspace.max_W) {
    return "workspace";
  }
  if (one.declared.force != other.declared.force ||
      one.declared.stiffness != other.declared.stiffness ||
      one.declared.damping != other.declared.damping) {
    return "declared";
  }
  if (one.velocity_corner_frequency != other.velocity_corner_frequency) {
    return "velocity_corner_frequency";
  }
  return nullptr;
}

}  // namespace thimble::scene
