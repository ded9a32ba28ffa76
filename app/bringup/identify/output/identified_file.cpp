#include "bringup/identify/output/identified_file.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string_view>
#include <vector>

#include "bringup/identify/output/file_lines.h"
#include "bringup/identify/output/identified_further.h"
#include "bringup/identify/output/links_section.h"
#include "output/output_file.h"
#include "read_scene.h"
#include "system/regular_file.h"
#include "yaml/yaml_reader.h"

namespace thimble::bringup {
namespace {

driver::Error bad_form(std::string_view key) {
  return driver::Error{
      fmt::format("The arm file has no {} that can be replaced. Write each key on a separate line, "
                  "as in app/arms/vintage_phantom.yaml.",
                  key)};
}

bool near(double value, double wanted) {
  return std::abs(value - wanted) <= 1e-5 * std::abs(wanted) + 1e-12;
}

bool near_train(double value, double wanted) {
  return std::abs(value - wanted) <= 1e-4 * wanted;
}

/// Replaces the torque constants, or adds them if the file leaves them to the program, and returns
/// them.
driver::Result<void> put_torques(const YAML::Node& root, const scene::ArmFile& before,
                                 const ArmConstants& found, const IdentifiedMark& mark,
                                 FileLines& lines, std::array<double, 3>& torque) {
  double error = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double declared = before.model.drives[i].torque_constant;
    torque[i] = declared * found.gain[i].value;
    error = std::max(error, declared * found.gain[i].plus_minus);
  }
  std::string list;
  for (int i = 0; i < before.motors(); ++i) {
    list += fmt::format("{}{:.6g}", i == 0 ? "" : ", ", torque[static_cast<std::size_t>(i)]);
  }
  const std::string values =
      fmt::format("[{}]  # N m/A at the motor{} [I {}, {}, +- {:.2g}{}]", list,
                  before.is<driver::DeltaArm>() ? ", 1 A being 1000 motor values" : "", mark.date,
                  mark.arm, error, found.absolute ? "" : "; their mean is the declared value");
  const YAML::Node joints = root["joints"];
  bool put = false;
  if (joints && joints["torque_constant"]) {
    put = lines.exchange(joints["torque_constant"], values);
  } else if (joints && joints.IsMap() && joints.size() > 0) {
    put = joints.Style() != YAML::EmitterStyle::Flow &&
          lines.add_before(joints.begin()->first, {"torque_constant: " + values});
  } else {
    for (const auto& entry : root) {
      if (entry.first.as<std::string>() != "base") continue;
      put = lines.add_before(entry.first, {"joints:", "  torque_constant: " + values, ""});
    }
  }
  if (put) return {};
  return bad_form("joints.torque_constant");
}

/// Replaces the delays. The bus and the converter of a Falcon are code, so their measured delay is
/// written as a comment.
bool put_delay(const YAML::Node& simulation, const scene::ArmFile& before, const Estimate& delay,
               const IdentifiedMark& mark, FileLines& lines) {
  if (before.is<driver::DeltaArm>()) {
    return lines.add_behind(
        simulation["tip"]["coulomb"],
        "# delay from force to motion: " + marked(delay.value, "s", delay.plus_minus, mark));
  }
  const YAML::Node wire = simulation["wire"];
  if (!wire || !wire["delay_in"] || !wire["delay_out"]) return false;
  // Motion only shows the sum of both delays.
  const double in =
      std::min(delay.value, 1e-9 * static_cast<double>(before.simulated.wire.delay_in_ns));
  const double out = std::round(1e9 * (delay.value - in)) * 1e-9;
  const char* unit = "s; the sum of both is measured";
  return lines.exchange(wire["delay_in"], marked(in, unit, delay.plus_minus, mark)) &&
         lines.exchange(wire["delay_out"], marked(out, unit, delay.plus_minus, mark));
}

/// One constant of the drive train, joint by joint.
struct TrainConstant {
  const char* key;
  const char* unit;
  Estimate CableConstants::*member;
  bool always = false;  // the others only if there is some, or was

  std::string values(const std::array<CableConstants, 3>& cables) const {
    return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", (cables[0].*member).value,
                       (cables[1].*member).value, (cables[2].*member).value);
  }

  std::string text(const std::array<CableConstants, 3>& cables, const IdentifiedMark& mark) const {
    return fmt::format("{}  # {} at the joints [I {}, {}, +- {:.2g}, {:.2g}, {:.2g}]",
                       values(cables), unit, mark.date, mark.arm, (cables[0].*member).plus_minus,
                       (cables[1].*member).plus_minus, (cables[2].*member).plus_minus);
  }
};

constexpr TrainConstant kTrainConstants[] = {
    {"stiffness", "N m/rad", &CableConstants::stiffness, true},
    {"inertia", "kg m^2", &CableConstants::inertia, true},
    {"damping", "N m s/rad", &CableConstants::damping, true},
    {"play", "rad, whole width", &CableConstants::play},
    {"viscous", "N m s/rad", &CableConstants::viscous},
    {"coulomb", "N m", &CableConstants::coulomb}};

/// Returns the constants to write.
std::vector<TrainConstant> train_constants(const YAML::Node& train,
                                           const std::array<CableConstants, 3>& cables) {
  std::vector<TrainConstant> all;
  for (const TrainConstant& one : kTrainConstants) {
    const bool some = std::any_of(cables.begin(), cables.end(), [&](const CableConstants& cable) {
      return (cable.*one.member).value > 0;
    });
    if (one.always || some || (train && train[one.key])) all.push_back(one);
  }
  return all;
}

/// Replaces stiffness, inertia, damping, backlash and friction of the drive train, or adds the
/// section before `tip`.
bool put_train(const YAML::Node& simulation, const std::array<CableConstants, 3>& cables,
               const IdentifiedMark& mark, FileLines& lines) {
  const YAML::Node train = simulation["drive_train"];
  const std::vector<TrainConstant> constants = train_constants(train, cables);
  if (train && train.Style() == YAML::EmitterStyle::Flow) {
    // On one line: the marks of all its values at the end.
    YAML::Node changed = YAML::Clone(train);
    std::string marks;
    for (const TrainConstant& constant : constants) {
      changed[constant.key] = YAML::Load(constant.values(cables));
      marks += fmt::format("; {}: {}", constant.key,
                           constant.text(cables, mark).substr(constant.values(cables).size() + 4));
    }
    changed.SetStyle(YAML::EmitterStyle::Flow);
    return lines.exchange(train, YAML::Dump(changed) + "  # " + marks.substr(2));
  }
  if (train) {
    return std::all_of(constants.begin(), constants.end(), [&](const TrainConstant& constant) {
      const std::string text = constant.text(cables, mark);
      if (train[constant.key]) return lines.exchange(train[constant.key], text);
      return !constant.always &&
             lines.add_behind(train["damping"], std::string(constant.key) + ": " + text);
    });
  }
  std::vector<std::string> section{"drive_train:"};
  for (const TrainConstant& constant : constants) {
    section.push_back(fmt::format("  {}: {}", constant.key, constant.text(cables, mark)));
  }
  for (const auto& entry : simulation) {
    if (entry.first.as<std::string>() == "tip") return lines.add_before(entry.first, section);
  }
  return false;
}

}  // namespace

std::string marked(double value, const std::string& unit, double plus_minus,
                   const IdentifiedMark& mark) {
  return fmt::format("{:.6g}  # {} [I {}, {}, +- {:.2g}]", value, unit, mark.date, mark.arm,
                     plus_minus);
}

driver::Result<std::string> identified_text(const std::string& text, const ArmConstants& found,
                                            const IdentifiedMark& mark) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& wrong) {
    return driver::Error{std::string("The arm file is not valid YAML: ") + wrong.what()};
  }
  auto was = scene::YamlFile::parse(text, "arm file");
  if (!was) return was.error();
  const auto before = scene::read_arm(*was);
  if (!before) return before.error();
  if (!before->can_simulate) return bad_form("section simulation");
  if (before->simulated.links.named() && !found.links_sought) {
    return driver::Error{
        "The arm file has simulation.links, but links were not measured; the mass of the tip would "
        "contain their inertia a second time. Identify with --places, or remove the section from a "
        "copy and pass it with --arm."};
  }
  FileLines lines(text);
  const YAML::Node tip = root["simulation"]["tip"];
  const auto put = [&](const YAML::Node& node, double value, const char* unit, double plus_minus) {
    return node && lines.exchange(node, marked(value, unit, plus_minus, mark));
  };
  if (!put(tip["mass"], found.mass.value, "kg, apparent", found.mass.plus_minus)) {
    return bad_form("simulation.tip.mass");
  }
  // Friction of an arm is never negative, whatever the fit gives.
  const double viscous = std::max(0.0, found.viscous.value);
  const double coulomb = std::max(0.0, found.coulomb.value);
  if (!put(tip["viscous"], viscous, "N s/m", found.viscous.plus_minus) ||
      !put(tip["coulomb"], coulomb, "N per axis", found.coulomb.plus_minus)) {
    return bad_form("simulation.tip friction");
  }
  // A weight that does not differ significantly from zero is omitted.
  const bool has_weight = static_cast<bool>(tip["weight"]);
  const bool weighs = found.weight.value > found.weight.plus_minus;
  const double weight = weighs ? found.weight.value : 0;
  const std::string weighed = marked(weight, "N", found.weight.plus_minus, mark);
  if (has_weight ? !lines.exchange(tip["weight"], weighed)
                 : weighs && !lines.add_behind(tip["coulomb"], "weight: " + weighed)) {
    return bad_form("simulation.tip");
  }
  if (!put_delay(root["simulation"], *before, found.delay, mark, lines)) {
    return bad_form("simulation.wire");
  }
  if (found.cables && before->is<driver::DeltaArm>()) {
    return driver::Error{
        "The cables of this arm stretch, but the simulation has no drive train for its geometry; "
        "no file was written."};
  }
  if (found.cables && !put_train(root["simulation"], *found.cables, mark, lines)) {
    return bad_form("section drive_train");
  }
  if (auto put_section = put_links(root["simulation"], found, mark, lines); !put_section) {
    return put_section.error();
  }
  std::array<double, 3> torque{};
  if (auto put_torque = put_torques(root, *before, found, mark, lines, torque); !put_torque) {
    return put_torque.error();
  }
  const std::string written = lines.text();
  auto yaml = scene::YamlFile::parse(written, "identified arm file");
  if (!yaml) return yaml.error();
  const auto read = scene::read_arm(*yaml);
  if (!read) return read.error();
  bool right = near(read->simulated.plant.mass, found.mass.value) &&
               near(read->simulated.plant.viscous, viscous) &&
               near(read->simulated.plant.coulomb, coulomb) &&
               near(read->simulated.weight_B.norm(), has_weight || weighs ? weight : 0);
  right = right && reads_links(read->simulated.links, found);
  const auto& train = read->simulated.drive_train;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (found.cables) {
      const CableConstants& cable = (*found.cables)[i];
      right = right && near_train(train.stiffness[k], cable.stiffness.value) &&
              near_train(train.play[k], cable.play.value) &&
              near_train(train.viscous[k], cable.viscous.value) &&
              near_train(train.coulomb[k], cable.coulomb.value);
    }
    right =
        right && (k >= read->motors() || near(read->model.drives[i].torque_constant, torque[i]));
  }
  if (!right) return bad_form("form");
  return written;
}

namespace {

driver::Result<std::string> text_of(const std::filesystem::path& arm_file) {
  constexpr std::uint64_t kMaxBytes = 4'000'000;  // as for every arm file
  auto content = driver::read_file(arm_file, kMaxBytes);
  if (!content) {
    return driver::Error{"The arm file " + arm_file.string() + ": " + content.error().message};
  }
  return content;
}

driver::Result<void> write_new(const std::filesystem::path& new_file, const std::string& text) {
  return output::write_file(new_file, output::kArmFile, text);
}

}  // namespace

driver::Result<void> check_new_file(const std::filesystem::path& new_file) {
  std::error_code failed;
  if (!std::filesystem::exists(new_file, failed) && !failed) return {};
  return driver::Error{new_file.string() +
                       " already exists and is not overwritten. Pass another file with --output."};
}

driver::Result<void> write_identified(const std::filesystem::path& arm_file,
                                      const std::filesystem::path& new_file,
                                      const ArmConstants& constants, const IdentifiedMark& mark) {
  if (auto free = check_new_file(new_file); !free) return free;
  const auto content = text_of(arm_file);
  if (!content) return content.error();
  const auto text = identified_text(*content, constants, mark);
  if (!text) return text.error();
  return write_new(new_file, *text);
}

driver::Result<void> write_identified(const std::filesystem::path& arm_file,
                                      const std::filesystem::path& new_file,
                                      const Identified& found, const IdentifiedMark& mark) {
  if (auto free = check_new_file(new_file); !free) return free;
  const auto content = text_of(arm_file);
  if (!content) return content.error();
  IdentifiedMark said = mark;
  std::string head;
  for (const std::string& sentence : found.against) head += "# BAD FIT: " + sentence + "\n";
  if (!found.against.empty()) said.arm += ", BAD FIT";
  const auto text = identified_text(*content, found.constants, said);
  if (!text) return text.error();
  const auto whole = further_text(*text, found, said);
  if (!whole) return whole.error();
  return write_new(new_file, head + *whole);
}

}  // namespace thimble::bringup
