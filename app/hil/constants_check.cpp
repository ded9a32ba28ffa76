#include "hil/constants_check.h"

#include <fmt/format.h>

#include <cmath>

#include "bringup/identify/identify.h"

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

}  // namespace

HilResult check_constants(const HilRig& rig, double seconds) {
  if (rig.file.is<driver::DeltaArm>() || rig.file.is<driver::ToldArm>()) {
    return skipped(kName, "An arm of this build cannot be identified yet.");
  }
  const OpenBench open = [&](bool) { return rig.open(TipHold::kFree); };
  IdentifyOptions options;
  options.seconds = seconds;
  const auto found = identify(open, rig.file, options, rig.stop);
  // What moves otherwise than it is asked to is not pushed further.
  if (!found) return broken_off(kName, found.error().message, nullptr);
  const ArmConstants& is = found->constants;
  const auto& plant = rig.file.simulated.plant;
  const auto& wire = rig.file.simulated.wire;
  const double delay = static_cast<double>(wire.delay_in_ns + wire.delay_out_ns) * 1e-9;
  std::vector<Figure> figures{
      difference("mass", is.mass, plant.mass, kTenth * plant.mass),
      difference("dry_friction", is.coulomb, plant.coulomb, kThird * plant.coulomb),
      difference("delay", is.delay, delay, kDelay)};
  for (std::size_t i = 0; i < 3; ++i) {
    figures.push_back(difference(fmt::format("gain_{}", i + 1).c_str(), is.gain[i], 1, kTenth));
  }
  std::string text = fmt::format(
      "Mass {:.1f} g (file {:.1f}), dry friction {:.1f} mN ({:.1f}), delay {:.2f} ms ({:.2f}), "
      "gains "
      "{:.3f}, {:.3f}, {:.3f} of the file's.",
      1e3 * is.mass.value, 1e3 * plant.mass, 1e3 * is.coulomb.value, 1e3 * plant.coulomb,
      1e3 * is.delay.value, 1e3 * delay, is.gain[0].value, is.gain[1].value, is.gain[2].value);
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
