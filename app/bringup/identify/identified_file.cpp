#include "bringup/identify/identified_file.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

#include "read_scene.h"
#include "yaml/yaml_reader.h"

namespace thimble::app {
namespace {

/// The lines of a text in which the rest of a line can be exchanged, from where a value stands.
class Lines {
 public:
  explicit Lines(const std::string& text) {
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines_.push_back(line);
  }

  bool exchange(const YAML::Node& value, const std::string& by) {
    const YAML::Mark mark = value.Mark();
    const auto at = static_cast<std::size_t>(mark.line);
    const auto column = static_cast<std::size_t>(mark.column);
    if (mark.is_null() || at >= lines_.size() || column > lines_[at].size()) return false;
    lines_[at] = lines_[at].substr(0, column) + by;
    return true;
  }

  /// Puts a line behind that of a value, as far in as its key.
  bool add_behind(const YAML::Node& value, const std::string& line) {
    const YAML::Mark mark = value.Mark();
    const auto at = static_cast<std::size_t>(mark.line);
    if (mark.is_null() || at >= lines_.size()) return false;
    const std::size_t indent = lines_[at].find_first_not_of(' ');
    if (indent == std::string::npos) return false;
    added_.emplace_back(at, std::string(indent, ' ') + line);
    return true;
  }

  /// Puts lines before that of a key, as far in as it.
  bool add_before(const YAML::Node& key, const std::vector<std::string>& lines) {
    const YAML::Mark mark = key.Mark();
    const auto at = static_cast<std::size_t>(mark.line);
    if (mark.is_null() || at == 0 || at >= lines_.size()) return false;
    for (const std::string& line : lines) {
      added_.emplace_back(at - 1, std::string(static_cast<std::size_t>(mark.column), ' ') + line);
    }
    return true;
  }

  std::string text() const {
    std::string whole;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      whole += lines_[i] + '\n';
      for (const auto& [at, line] : added_) {
        if (at == i) whole += line + '\n';
      }
    }
    return whole;
  }

 private:
  std::vector<std::string> lines_;
  std::vector<std::pair<std::size_t, std::string>> added_;
};

driver::Error bad_form(std::string_view key) {
  return driver::Error{
      fmt::format("The arm file has no {} that could be exchanged; write each of its keys on a "
                  "line of its own, "
                  "as app/arms/vintage_phantom.yaml does.",
                  key)};
}

std::string marked(double value, const char* unit, double plus_minus, const IdentifiedMark& mark) {
  return fmt::format("{:.6g}  # {} [I {}, {}, +- {:.2g}]", value, unit, mark.date, mark.arm,
                     plus_minus);
}

bool near(double value, double wanted) {
  return std::abs(value - wanted) <= 1e-5 * std::abs(wanted) + 1e-12;
}

bool near_train(double value, double wanted) {
  return std::abs(value - wanted) <= 1e-4 * wanted;
}

/// Exchanges the torque constants, and returns them. Those of some arms are built into the program:
/// theirs must be what was found.
driver::Result<void> put_torques(const YAML::Node& root, const scene::ArmFile& before,
                                 const ArmConstants& found, const IdentifiedMark& mark,
                                 Lines& lines, std::array<double, 3>& torque) {
  constexpr double kSame = 0.02;
  const YAML::Node joints = root["joints"];
  const bool built_in = !joints || !joints["torque_constant"];
  double error = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double declared = before.model.drives[i].torque_constant;
    const Estimate& gain = found.gain[i];
    torque[i] = built_in ? declared : declared * gain.value;
    error = std::max(error, declared * gain.plus_minus);
    if (built_in && std::abs(gain.value - 1) > std::max(kSame, gain.plus_minus)) {
      return driver::Error{fmt::format(
          "This arm's torque constants are built into the program and cannot stand in its file, "
          "but motor {} has {:.3f} times its own. Check its amplifier; nothing was written.",
          i + 1, gain.value)};
    }
  }
  if (built_in) return {};
  if (lines.exchange(joints["torque_constant"],
                     fmt::format("[{:.6g}, {:.6g}, {:.6g}]  # N m/A at the motor [I {}, {}, +- "
                                 "{:.2g}{}]",
                                 torque[0], torque[1], torque[2], mark.date, mark.arm, error,
                                 found.absolute ? "" : "; their mean is the declared one's"))) {
    return {};
  }
  return bad_form("joints.torque_constant");
}

/// One constant of the drive train, joint by joint.
struct TrainConstant {
  const char* key;
  const char* unit;
  Estimate CableConstants::*member;

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

constexpr TrainConstant kTrainConstants[] = {{"stiffness", "N m/rad", &CableConstants::stiffness},
                                             {"inertia", "kg m^2", &CableConstants::inertia},
                                             {"damping", "N m s/rad", &CableConstants::damping}};

/// Exchanges stiffness, inertia and damping of the drive train, or adds the section before `tip`.
bool put_train(const YAML::Node& simulation, const std::array<CableConstants, 3>& cables,
               const IdentifiedMark& mark, Lines& lines) {
  const YAML::Node train = simulation["drive_train"];
  if (train && train.Style() == YAML::EmitterStyle::Flow) {
    // On one line: the marks of all that it says behind it.
    YAML::Node changed = YAML::Clone(train);
    std::string marks;
    for (const TrainConstant& constant : kTrainConstants) {
      changed[constant.key] = YAML::Load(constant.values(cables));
      marks += fmt::format("; {}: {}", constant.key,
                           constant.text(cables, mark).substr(constant.values(cables).size() + 4));
    }
    changed.SetStyle(YAML::EmitterStyle::Flow);
    return lines.exchange(train, YAML::Dump(changed) + "  # " + marks.substr(2));
  }
  if (train) {
    return std::all_of(std::begin(kTrainConstants), std::end(kTrainConstants),
                       [&](const TrainConstant& constant) {
                         return train[constant.key] &&
                                lines.exchange(train[constant.key], constant.text(cables, mark));
                       });
  }
  std::vector<std::string> section{"drive_train:"};
  for (const TrainConstant& constant : kTrainConstants) {
    section.push_back(fmt::format("  {}: {}", constant.key, constant.text(cables, mark)));
  }
  for (const auto& entry : simulation) {
    if (entry.first.as<std::string>() == "tip") return lines.add_before(entry.first, section);
  }
  return false;
}

}  // namespace

driver::Result<std::string> identified_text(const std::string& text, const ArmConstants& found,
                                            const IdentifiedMark& mark) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& wrong) {
    return driver::Error{std::string("The arm file is no YAML: ") + wrong.what()};
  }
  auto was = scene::YamlFile::parse(text, "arm file");
  if (!was) return was.error();
  const auto before = scene::read_arm(*was);
  if (!before) return before.error();
  if (!before->can_simulate || !root["simulation"]["wire"]) return bad_form("section simulation");
  if (before->simulated.links.named()) {
    return driver::Error{
        "The arm file names links (simulation.links), whose inertia would be in the identified "
        "mass "
        "of the tip as well: motion in one place tells no more than a mass. Take that section out "
        "of a copy, and name it by --arm."};
  }
  Lines lines(text);
  const YAML::Node tip = root["simulation"]["tip"], wire = root["simulation"]["wire"];
  const auto put = [&](const YAML::Node& node, double value, const char* unit, double plus_minus) {
    return node && lines.exchange(node, marked(value, unit, plus_minus, mark));
  };
  if (!put(tip["mass"], found.mass.value, "kg, apparent", found.mass.plus_minus)) {
    return bad_form("simulation.tip.mass");
  }
  // An arm has no friction below zero, whatever the fit says.
  const double viscous = std::max(0.0, found.viscous.value);
  const double coulomb = std::max(0.0, found.coulomb.value);
  const double weight = std::max(0.0, found.weight.value);
  if (!put(tip["viscous"], viscous, "N s/m", found.viscous.plus_minus) ||
      !put(tip["coulomb"], coulomb, "N per axis", found.coulomb.plus_minus)) {
    return bad_form("simulation.tip friction");
  }
  // A weight that cannot be told from none is none.
  const bool has_weight = static_cast<bool>(tip["weight"]);
  const bool weighs = found.weight.value > found.weight.plus_minus;
  const std::string weighed = marked(weight, "N", found.weight.plus_minus, mark);
  if (has_weight ? !lines.exchange(tip["weight"], weighed)
                 : weighs && !lines.add_behind(tip["coulomb"], "weight: " + weighed)) {
    return bad_form("simulation.tip");
  }
  // Motion shows the sum of both ways alone.
  const double delay_in =
      std::min(found.delay.value, 1e-9 * static_cast<double>(before->simulated.wire.delay_in_ns));
  const double delay_out = std::round(1e9 * (found.delay.value - delay_in)) * 1e-9;
  if (!put(wire["delay_in"], delay_in, "s; the sum of both is measured", found.delay.plus_minus) ||
      !put(wire["delay_out"], delay_out, "s; the sum of both is measured",
           found.delay.plus_minus)) {
    return bad_form("simulation.wire");
  }
  if (found.cables && !put_train(root["simulation"], *found.cables, mark, lines)) {
    return bad_form("section drive_train");
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
  const auto& train = read->simulated.drive_train;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    right = right &&
            (!found.cables || near_train(train.stiffness[k], (*found.cables)[i].stiffness.value));
    right = right && near(read->model.drives[i].torque_constant, torque[i]);
  }
  if (!right) return bad_form("form");
  return written;
}

driver::Result<void> write_identified(const std::filesystem::path& arm_file,
                                      const std::filesystem::path& new_file,
                                      const ArmConstants& constants, const IdentifiedMark& mark) {
  std::error_code failed;
  if (std::filesystem::exists(new_file, failed) || failed) {
    return driver::Error{new_file.string() +
                         " is there already, and no file is written over; name another by "
                         "--output."};
  }
  std::ifstream in(arm_file);
  std::ostringstream content;
  content << in.rdbuf();
  if (!in) return driver::Error{"The arm file " + arm_file.string() + " cannot be read."};
  const auto text = identified_text(content.str(), constants, mark);
  if (!text) return text.error();
  std::ofstream out(new_file);
  out << *text;
  out.close();
  if (!out) {
    return driver::Error{new_file.string() +
                         " cannot be written; look at its folder and its disk."};
  }
  return {};
}

}  // namespace thimble::app
