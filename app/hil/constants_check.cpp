#include "hil/constants_check.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "bringup/identify/identify.h"
#include "bringup/identify/links/place_masses.h"

namespace thimble::app {
namespace {

constexpr const char* kName = "constants";
// What an arm may differ by from its file before it is another arm [chosen: a rope that slackened
// or a motor that lost a tenth of its magnet is felt; friction hangs on the weather].
constexpr double kTenth = 0.1, kThird = 1.0 / 3, kDelay = 0.2e-3;

/// How far a constant is from the file, in units of what is allowed; its interval is forgiven.
Figure difference(const char* name, const Estimate& found, double named, double allowed) {
  const double beyond = std::max(0.0, std::abs(found.value - named) - found.plus_minus);
  return {std::string(name) + "_difference", beyond / allowed, "of what is allowed", "<= 1",
          fmt::format("found {:.5g} +- {:.2g}, file {:.5g}", found.value, found.plus_minus, named)};
}

/// Puts in how far the mass along each axis of the base is from the file's, in the middle of the
/// workspace, and says it: that of an arm whose file names links hangs on the pose.
std::string add_masses(const LinkFit& found, const scene::ArmFile& file,
                       std::vector<Figure>& figures) {
  const auto q = found.arm.inverse(file.R_WB.transpose() * (file.workspace.middle() - file.p_WB))
                     .value_or(Eigen::Vector3d::Zero());
  const std::array<Estimate, 3> is = found.apparent_mass(q);
  const std::array<double, 3> named = named_masses(file, q);
  constexpr std::array kNames = {"mass_x", "mass_y", "mass_z"};
  for (std::size_t i = 0; i < 3; ++i) {
    figures.push_back(difference(kNames[i], is[i], named[i], kTenth * named[i]));
  }
  return fmt::format(
      "Mass along x, y, z in the middle {:.1f}, {:.1f}, {:.1f} g (file {:.1f}, {:.1f}, {:.1f})",
      1e3 * is[0].value, 1e3 * is[1].value, 1e3 * is[2].value, 1e3 * named[0], 1e3 * named[1],
      1e3 * named[2]);
}

}  // namespace

HilResult check_constants(const HilRig& rig, double seconds) {
  if (rig.file.is<driver::DeltaArm>() || rig.file.is<driver::ToldArm>()) {
    return skipped(kName, "An arm of this build cannot be identified yet.");
  }
  const OpenBench open = [&](bool) { return rig.open(TipHold::kFree); };
  IdentifyOptions options;
  options.seconds = seconds;
  // Links that the file names show over the workspace alone.
  if (rig.file.simulated.links.named()) options.places = 5, options.place_seconds = 2;
  const auto found = identify(open, rig.file, options, rig.stop);
  // What moves otherwise than it is asked to is not pushed further.
  if (!found) return broken_off(kName, found.error().message, nullptr);
  const ArmConstants& is = found->constants;
  const auto& plant = rig.file.simulated.plant;
  const auto& wire = rig.file.simulated.wire;
  const double delay = static_cast<double>(wire.delay_in_ns + wire.delay_out_ns) * 1e-9;
  std::vector<Figure> figures;
  std::string masses =
      fmt::format("Mass {:.1f} g (file {:.1f})", 1e3 * is.mass.value, 1e3 * plant.mass);
  if (options.places > 0 && found->over.fit) {
    masses = add_masses(*found->over.fit, rig.file, figures);
  } else {
    figures.push_back(difference("mass", is.mass, plant.mass, kTenth * plant.mass));
  }
  figures.push_back(difference("dry_friction", is.coulomb, plant.coulomb, kThird * plant.coulomb));
  figures.push_back(difference("delay", is.delay, delay, kDelay));
  for (std::size_t i = 0; i < 3; ++i) {
    figures.push_back(difference(fmt::format("gain_{}", i + 1).c_str(), is.gain[i], 1, kTenth));
  }
  std::string text = fmt::format(
      "{}, dry friction {:.1f} mN ({:.1f}), delay {:.2f} ms ({:.2f}), "
      "gains "
      "{:.3f}, {:.3f}, {:.3f} of the file's.",
      masses, 1e3 * is.coulomb.value, 1e3 * plant.coulomb, 1e3 * is.delay.value, 1e3 * delay,
      is.gain[0].value, is.gain[1].value, is.gain[2].value);
  for (const std::string& sentence : found->against) text += " " + sentence;
  figures.push_back({"model_misfits", static_cast<double>(found->against.size()), "", "== 0", ""});
  HilResult result = judged(kName, text, std::move(figures));
  if (result.outcome == HilOutcome::kFailed) {
    result.text +=
        " If the file was never fitted to this arm, run `thimble identify`; else the arm "
        "has changed.";
  }
  return result;
}

}  // namespace thimble::app
