#include "usb/hidden_file.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <optional>
#include <sstream>
#include <variant>

#include "plant/tip_kinematics.h"
#include "support/identify/cabled_arm.h"
#include "support/identify/hidden_arm.h"
#include "thimble/scene/arm_file.h"
#include "usb/board_checks.h"

namespace thimble::usb_test {
namespace {

// Cables of a large arm. They correspond to 25 to 250 N m/rad and motors of 1e-4 to 9e-4 kg m^2 on
// the vintage PHANTOM, whose links are half as long.
constexpr double kSoftest = 100;    // N m/rad
constexpr double kLightest = 4e-4;  // kg m^2

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string exact(const Eigen::Vector3d& values) {
  return "[" + exact(values[0]) + ", " + exact(values[1]) + ", " + exact(values[2]) + "]";
}

/// Replaces the value of the first key of that name after `from`; returns false if there is none.
bool exchange(std::string& text, const std::string& key, const std::string& value,
              std::size_t from = 0) {
  const std::size_t at = text.find(key + ": ", from);
  if (at == std::string::npos) return false;
  const std::size_t begin = at + key.size() + 2;
  text.replace(begin, text.find('\n', begin) - begin, value);
  return true;
}

/// Inserts lines after the line that begins with `key`. Precondition: it exists.
void put_behind(std::string& text, const std::string& key, const std::string& lines) {
  text.insert(text.find('\n', text.find(key) + 1) + 1, lines);
}

/// Writes the torque constants into a file, which may lack them or all joints.
void put_torques(std::string& text, const std::string& values) {
  if (exchange(text, "  torque_constant", values)) return;
  const std::string line = "  torque_constant: " + values + "\n";
  if (text.find("\njoints:") != std::string::npos) {
    put_behind(text, "\njoints:", line);
  } else {
    text.insert(text.find("\nbase:") + 1, "joints:\n" + line + "\n");
  }
}

/// Returns the half-width of the interval in the comment of a key: the first after `from` whose
/// line has one.
std::optional<double> stated(const std::string& text, const std::string& from,
                             const std::string& key) {
  const std::size_t section = text.find(from);
  const std::size_t at = text.find(key + ": ", section == std::string::npos ? 0 : section);
  if (at == std::string::npos) return std::nullopt;
  const std::string line = text.substr(at, text.find('\n', at) - at);
  const std::size_t mark = line.find("+- ");
  if (mark == std::string::npos) return std::nullopt;
  return std::strtod(line.c_str() + mark + 3, nullptr);
}

/// A constant of a written file and its true value.
struct Compared {
  std::string name, unit;
  double found, truth, allowed;    // in the unit; `allowed`: largest allowed error
  std::optional<double> interval;  // half-width in the file
  bool interval_will_do = false;   // a true value inside it is also accepted

  int say(const std::string& arm) const {
    const double off = std::abs(found - truth);
    const bool held = interval && off <= *interval;
    const bool good = found * truth >= 0 && (off <= allowed || (interval_will_do && held));
    char text[200], held_by[30] = "";
    if (interval) std::snprintf(held_by, sizeof held_by, "+- %.2g", *interval);
    std::snprintf(text, sizeof text, "%.6g %s%s, true %.6g: %.3g off (%.2f %%), allowed %.3g",
                  found, (unit.empty() ? unit : unit + " ").c_str(), held_by, truth, off,
                  100 * off / std::abs(truth), allowed);
    const bool in_ms = unit == "ms";
    std::printf("FIGURE %s.identified_%s_off %.4g %s\n", arm.c_str(), name.c_str(),
                in_ms ? off : 100 * off / std::abs(truth), in_ms ? "ms" : "%");
    return verdict(good, arm + " identified: " + name,
                   text + std::string(!interval ? ""
                                      : held    ? "; inside its interval"
                                                : "; outside its interval"));
  }
};

/// Returns the frequencies (Hz) at which the motors of a simulated arm oscillate against its links,
/// each with the other joints held and the tip at the world's origin.
Eigen::Vector3d resonances(const scene::ArmFile& file) {
  const Eigen::Vector3d p_BT = file.R_WB.transpose() * -file.p_WB;
  const auto pose = device_sim::tip_pose(std::get<driver::SerialArm>(file.model.geometry), p_BT);
  if (!pose) return Eigen::Vector3d::Constant(NAN);
  const Eigen::Vector3d link =
      file.simulated.plant.mass * pose->G.inverse().colwise().squaredNorm().transpose();
  const auto& train = file.simulated.drive_train;
  return (train.stiffness.array() * (1 / link.array() + 1 / train.inertia.array())).sqrt() /
         (2 * std::numbers::pi);
}

}  // namespace

int print_hidden_file(const std::string& file, const std::string& seed, bool cables) {
  auto known = scene::load_arm(file);
  if (!known) return verdict(false, file, known.error().message);
  const std::uint64_t number = std::strtoull(seed.c_str(), nullptr, 10);
  support::HiddenArm arm = support::hidden_arm_of(std::move(*known), number);
  std::string text = text_of(file);
  const std::size_t tip = text.find("\n  tip:");
  const auto& plant = arm.file.simulated.plant;
  const bool whole = tip != std::string::npos && exchange(text, "mass", exact(plant.mass), tip) &&
                     exchange(text, "viscous", exact(plant.viscous), tip) &&
                     exchange(text, "coulomb", exact(plant.coulomb), tip);
  if (!whole) return verdict(false, file, "has no constants of a simulated tip");
  Eigen::Vector3d torques;
  for (std::size_t i = 0; i < 3; ++i) {
    torques[static_cast<Eigen::Index>(i)] = arm.gain[i] * arm.file.model.drives[i].torque_constant;
  }
  put_torques(text, exact(torques));
  if (cables) {
    support::put_cables(arm, number, kSoftest, kLightest);
    const auto& train = arm.file.simulated.drive_train;
    put_behind(text, "\nsimulation:",
               "  drive_train:\n    stiffness: " + exact(train.stiffness) + "\n    inertia: " +
                   exact(train.inertia) + "\n    damping: " + exact(train.damping) + "\n");
  }
  std::printf("%s", text.c_str());
  return 0;
}

int check_identified(const std::string& arm, const std::string& believed, const std::string& hidden,
                     const std::string& written, const std::string& delay_ms) {
  const auto wrong = scene::load_arm(believed);
  const auto truth = scene::load_arm(hidden), found = scene::load_arm(written);
  if (!wrong) return verdict(false, arm + " file", wrong.error().message);
  if (!truth) return verdict(false, arm + " hidden file", truth.error().message);
  if (!found) return verdict(false, arm + " identified", found.error().message);
  const std::string text = text_of(written);
  const auto &is = truth->simulated, &was = found->simulated;
  const auto of_tip = [&](const char* key) { return stated(text, "\n  tip:", key); };
  std::vector<Compared> all{
      {"mass", "kg", was.plant.mass, is.plant.mass, 0.03 * is.plant.mass, of_tip("mass")},
      {"coulomb", "N", was.plant.coulomb, is.plant.coulomb, 0.05 * is.plant.coulomb,
       of_tip("coulomb")},
      {"viscous", "N s/m", was.plant.viscous, is.plant.viscous, 0.1 * is.plant.viscous,
       of_tip("viscous"), true}};
  const auto torque = stated(text, "\njoints:", "torque_constant");
  for (std::size_t i = 0; i < 3; ++i) {
    const double named = wrong->model.drives[i].torque_constant;
    const double gain = truth->model.drives[i].torque_constant / named;
    all.push_back({"gain_" + std::to_string(i + 1), "",
                   found->model.drives[i].torque_constant / named, gain, 0.02 * gain,
                   torque ? std::optional(*torque / named) : std::nullopt});
  }
  // The bus of a Falcon is defined in code, and its delay is a comment in the file.
  const bool remark = found->is<driver::DeltaArm>();
  const std::string key = remark ? "# delay from force to motion" : "delay_out";
  const std::size_t at = text.find("# delay from force to motion: ");
  const double delay =
      !remark ? 1e-9 * static_cast<double>(was.wire.delay_in_ns + was.wire.delay_out_ns)
      : at == std::string::npos ? NAN
                                : std::strtod(text.c_str() + at + key.size() + 2, nullptr);
  const auto interval = stated(text, "\nsimulation:", key);
  all.push_back({"delay", "ms", 1e3 * delay, std::strtod(delay_ms.c_str(), nullptr), 0.1,
                 interval ? std::optional(1e3 * *interval) : std::nullopt});
  if (is.drive_train.compliant()) {
    const Eigen::Vector3d true_ones = resonances(*truth), found_ones = resonances(*found);
    for (int i = 0; i < 3; ++i) {
      all.push_back({"resonance_" + std::to_string(i + 1), "Hz", found_ones[i], true_ones[i],
                     0.05 * true_ones[i], std::nullopt});
    }
  }
  int bad = 0;
  for (const Compared& one : all) bad += one.say(arm);
  return bad;
}

}  // namespace thimble::usb_test
