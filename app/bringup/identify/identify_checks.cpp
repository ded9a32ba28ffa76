#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bringup/identify/identify.h"
#include "gravity_terms.h"

namespace thimble::bringup {
namespace {

// The residual of a correct model is 1 to 4 times that of its encoders' steps, or below 1 % of its
// acceleration for a light arm. That of a wrong model exceeds both.
constexpr double kResidualMax = 4;
constexpr double kUnexplainedMax = 0.02;
// Behind cables the motion of the links is known only through them. The residual of correct soft
// arms is up to 4 %, 8 times the encoders' steps [measured: soft arms 6000 to 6012].
constexpr double kCableResidualMax = 8;
constexpr double kCableUnexplainedMax = 0.05;
// Springs softer than this cannot be distinguished from an axis that sticks now and then.
constexpr double kSpringMin = 10;  // N/m
// Max. share of the pieces of motion that may be omitted because an axis stood still.
constexpr double kLeftOutMax = 0.75;
constexpr double kForceMin = 0.2;       // N [chosen: twice the dry friction of the supported arms]
constexpr double kCarriedMax = 0.6;     // of the max. force, to carry a known mass
constexpr double kKnownMassMax = 0.06;  // kg [chosen: no grip should be heavier than its arm]

}  // namespace

bool is_held(const MassNormalisedFit& held, double mass) {
  const double spring = held.theta[MassNormalisedFit::kStiffness] * mass;
  const double error =
      std::sqrt(held.covariance(MassNormalisedFit::kStiffness, MassNormalisedFit::kStiffness)) *
      mass;
  return std::abs(spring) > kSpringMin && std::abs(spring) > 5 * error;
}

std::vector<std::string> fit_warnings(const MassNormalisedFit& fit, const MassNormalisedFit& held,
                                      double mass, bool stretches) {
  std::vector<std::string> against;
  if (is_held(held, mass)) {
    against.push_back(
        fmt::format("Something holds the tip like a spring of {:.0f} N/m. Let go of the grip, and "
                    "keep cables off the arm.",
                    held.theta[MassNormalisedFit::kStiffness] * mass));
  }
  const double times = fit.residual / fit.noise;
  const double unexplained = std::sqrt(std::max(0.0, 1 - fit.explained));
  if (times > (stretches ? kCableResidualMax : kResidualMax) &&
      unexplained > (stretches ? kCableUnexplainedMax : kUnexplainedMax)) {
    against.push_back(fmt::format(
        "The motion does not fit a rigid arm with dry and viscous friction: the residual is {:.1f} "
        "% of the acceleration, {:.1f} times the noise of the encoder steps. Possible causes: "
        "cables that stretch, backlash, a joint that sticks, a hand, or missed encoder edges.",
        100 * unexplained, times));
  }
  const double all = static_cast<double>(fit.windows + fit.left_out);
  if (static_cast<double>(fit.left_out) > kLeftOutMax * all) {
    against.push_back(
        fmt::format("The tip was at rest for {:.0f} % of the motion: its friction is too high for "
                    "the allowed force. Allow more with --max-force.",
                    100 * static_cast<double>(fit.left_out) / all));
  }
  return against;
}

std::string late_ticks_text(const LateTicks& late) {
  return fmt::format(
      "The computer was late in {} of {} ticks, by up to {:.1f} ms, so forces acted for longer "
      "than recorded and the motion cannot be used. Give the loop real-time priority (see `thimble "
      "doctor`), close other programs, and repeat.",
      late.late, late.ticks, 1e3 * late.worst);
}

double default_max_force(const scene::ArmFile& file) {
  return std::min(kIdentifyForceMax, file.limits.force_max);
}

driver::Result<void> check_places(const scene::ArmFile& file, const IdentifyOptions& options) {
  if (file.motors() == 3 || options.places == 0) return {};
  return driver::Error{fmt::format(
      "--places {}: the inertia of links is identified for arms with three motors only, "
      "and {} has {}. Remove --places, or pass --places 0.",
      options.places, file.name, file.motors())};
}

driver::Result<void> check_forces(const scene::ArmFile& file, const IdentifyOptions& options) {
  if (!(options.max_force >= kForceMin)) {
    return driver::Error{fmt::format(
        "The force limit must be at least {:g} N; no known arm moves under less.", kForceMin)};
  }
  if (!(options.max_force <= file.limits.force_max)) {
    return driver::Error{fmt::format(
        "The force limit of {:g} N exceeds the {:g} N that the arm file allows (gate.force_max).",
        options.max_force, file.limits.force_max)};
  }
  // After carrying the mass, some force must remain to move it.
  const double carried = kCarriedMax * options.max_force / scene::kGravity;
  const double max_mass = std::min(kKnownMassMax, carried);
  if (!(options.known_mass >= 0 && options.known_mass <= max_mass)) {
    return driver::Error{
        fmt::format("The known mass must be at most {:.2g} kg; the arm must carry and shake it "
                    "with at most {:g} N.",
                    max_mass, options.max_force)};
  }
  return {};
}

}  // namespace thimble::bringup
