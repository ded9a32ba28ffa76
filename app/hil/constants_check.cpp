#include "hil/constants_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "bringup/identify/identify.h"
#include "bringup/identify/link_inertia/masses_per_pose.h"

namespace thimble::hil {
namespace {

constexpr const char* kName = "constants";
// Allowed differences between an arm and its file [chosen: a slack cable or a motor that lost a
// tenth of its magnet is perceptible; friction depends on the weather].
constexpr double kTenth = 0.1, kThird = 1.0 / 3, kDelay = 0.2e-3;
constexpr double kViscous = 0.01;  // N s/m, which dry friction hides at hand speeds [chosen]
constexpr double kWeight = 0.005;  // N [chosen: half a gram]
constexpr double kTilt = 3;        // degrees [chosen: a table levelled by eye]

/// Difference between a constant and the file, in units of the allowed one, less its interval.
session::Figure difference(const char* name, const bringup::Estimate& found, double named,
                           double allowed) {
  const double beyond = std::max(0.0, std::abs(found.value - named) - found.plus_minus);
  return {std::string(name) + "_difference", beyond / allowed, "of what is allowed", "<= 1",
          fmt::format("found {:.5g} +- {:.2g}, file {:.5g}", found.value, found.plus_minus, named)};
}

/// Adds the tilt of gravity, if there is a load on the tip: the known mass, or a weight of its own
/// of at least kWeightSeen. Returns a sentence, or an empty string.
std::string add_tilt(const bringup::Identified& found, double known_mass,
                     const Eigen::Vector3d& down_B, std::vector<session::Figure>& figures) {
  constexpr double kWeightSeen = 0.02;  // N
  const double mass = found.constants.mass.value;
  const auto pull = [&](const bringup::MassNormalisedFit& fit, double moved) -> Eigen::Vector3d {
    return moved * fit.theta.segment<3>(bringup::MassNormalisedFit::kWeight);
  };
  Eigen::Vector3d weight_B = pull(found.bare, mass);
  if (found.loaded) weight_B = pull(*found.loaded, mass + known_mass) - weight_B;
  if (!found.loaded && !(weight_B.norm() > kWeightSeen)) return "";
  const double tilt =
      std::atan2(weight_B.cross(down_B).norm(), weight_B.dot(down_B)) * 180 / std::numbers::pi;
  figures.push_back({"base_tilt", tilt, "degrees", fmt::format("<= {:g}", kTilt), ""});
  return fmt::format(" Gravity is tilted by {:.1f} degrees{}.", tilt,
                     tilt > kTilt ? " from the direction that `base` of the arm file gives" : "");
}

/// Adds the difference between the mass along each axis of the base and the file's, in the middle
/// of the workspace, and returns a sentence. With links in its file, the mass of an arm depends on
/// the pose.
std::string add_masses(const bringup::LinkFit& found, const scene::ArmFile& file,
                       std::vector<session::Figure>& figures) {
  const auto q = found.arm.inverse(file.R_WB.transpose() * (file.workspace.middle() - file.p_WB))
                     .value_or(Eigen::Vector3d::Zero());
  const std::array<bringup::Estimate, 3> is = found.apparent_mass(q);
  const std::array<double, 3> named = bringup::named_masses(file, q);
  constexpr std::array kNames = {"mass_x", "mass_y", "mass_z"};
  for (std::size_t i = 0; i < 3; ++i) {
    figures.push_back(difference(kNames[i], is[i], named[i], kTenth * named[i]));
  }
  return fmt::format(
      "Mass along x, y, z in the middle of the workspace {:.1f}, {:.1f}, {:.1f} g (file {:.1f}, "
      "{:.1f}, {:.1f})",
      1e3 * is[0].value, 1e3 * is[1].value, 1e3 * is[2].value, 1e3 * named[0], 1e3 * named[1],
      1e3 * named[2]);
}

}  // namespace

HilResult check_constants(const HilRig& rig, const HilOptions& suite) {
  if (rig.file.is<driver::DeltaArm>() || rig.file.is<driver::VendorPoseArm>()) {
    return skipped(kName, "Arms of this geometry cannot be identified yet.");
  }
  if (suite.known_mass > 0 && !rig.attended) {
    return skipped(kName, "A person must fix the known mass to the tip (--attended).");
  }
  const bringup::OpenBench open =
      [&](bool loaded) -> driver::Result<std::unique_ptr<bringup::BenchArm>> {
    if (loaded &&
        !rig.prompt(fmt::format("Fix {:g} kg to the tip so that it cannot swing, and support it "
                                "from below. Let go once you feel that the arm carries it.",
                                suite.known_mass))) {
      return driver::Error{"The prompt was cancelled before the known mass was on the tip."};
    }
    return rig.open(loaded ? TipHold::kMass : TipHold::kFree);
  };
  bringup::IdentifyOptions options;
  options.seconds = suite.full ? 60 : 15;
  options.known_mass = suite.known_mass;
  options.max_force = bringup::default_max_force(rig.file);
  // A user needs time to release the mass.
  if (suite.known_mass > 0 && suite.attended) options.lead = 4;
  // Links of the file are visible only over the workspace.
  if (rig.file.simulated.links.named() && rig.file.motors() == 3)
    options.places = 5, options.place_seconds = 2;
  driver::Fault fault = driver::Fault::kNone;
  options.watch = [&fault](const driver::TickRecord& tick) { fault = tick.fault; };
  const auto found = bringup::identify(open, rig.file, options, rig.stop);
  // An arm that does not move as requested gets no further force.
  if (!found) {
    HilResult result = broken_off(kName, found.error().message, nullptr);
    result.fault = fault != driver::Fault::kNone;
    return result;
  }
  const bringup::ArmConstants& is = found->constants;
  const auto& plant = rig.file.simulated.plant;
  const auto& wire = rig.file.simulated.wire;
  const Eigen::Vector3d down_B = rig.file.R_WB.transpose() * Eigen::Vector3d(0, 0, -1);
  // Mean value: a report and a message wait for half of the jitter each.
  const double delay =
      static_cast<double>(wire.delay_in_ns + wire.delay_out_ns + wire.jitter_ns) * 1e-9;
  std::vector<session::Figure> figures;
  std::string masses =
      fmt::format("Mass {:.1f} g (file {:.1f})", 1e3 * is.mass.value, 1e3 * plant.mass);
  if (options.places > 0 && found->over.fit) {
    masses = add_masses(*found->over.fit, rig.file, figures);
  } else {
    figures.push_back(difference("mass", is.mass, plant.mass, kTenth * plant.mass));
  }
  figures.push_back(difference("dry_friction", is.coulomb, plant.coulomb, kThird * plant.coulomb));
  figures.push_back(
      difference("viscous_friction", is.viscous, plant.viscous, std::max(plant.viscous, kViscous)));
  const double weight = rig.file.simulated.weight_B.dot(down_B);
  figures.push_back(
      difference("weight", is.weight, weight, std::max(kTenth * std::abs(weight), kWeight)));
  const std::string tilt = add_tilt(*found, suite.known_mass, down_B, figures);
  figures.push_back(difference("delay", is.delay, delay, kDelay));
  std::string gains;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rig.file.motors()); ++i) {
    figures.push_back(difference(fmt::format("gain_{}", i + 1).c_str(), is.gain[i], 1, kTenth));
    gains += fmt::format("{}{:.3f}", i == 0 ? "" : ", ", is.gain[i].value);
  }
  std::string text = fmt::format(
      "{}, dry friction {:.1f} mN ({:.1f}), viscous {:.3f} N s/m ({:.3f}), weight {:.1f} mN "
      "({:.1f}), delay {:.2f} ms ({:.2f}), {} {} of the file's.{}",
      masses, 1e3 * is.coulomb.value, 1e3 * plant.coulomb, is.viscous.value, plant.viscous,
      1e3 * is.weight.value, 1e3 * weight, 1e3 * is.delay.value, 1e3 * delay,
      rig.file.motors() == 1 ? "gain" : "gains", gains, tilt);
  for (const std::string& sentence : found->against) text += " " + sentence;
  figures.push_back({"model_misfits", static_cast<double>(found->against.size()), "", "== 0", ""});
  HilResult result = judged(kName, text, std::move(figures));
  if (result.outcome == HilOutcome::kFailed) {
    result.text +=
        " If the file was never fitted to this arm, run `thimble identify`. Otherwise the arm has "
        "changed.";
  }
  return result;
}

}  // namespace thimble::hil
