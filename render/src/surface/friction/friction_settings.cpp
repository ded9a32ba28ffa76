#include "surface/friction/friction_settings.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace thimble::render {
namespace {

// Rubber on clean glass reaches about 4 [M]; more is a misplaced decimal point.
constexpr double kCoefficientMax = 5;
constexpr double kCoefficient = 0.3;   // wood or metal under a tool [chosen]
constexpr double kHandDamping = 3;     // N s/m, pinch grip [PHYSICS 0]
constexpr double kSafety = 1.5;        // [PHYSICS 2.3]
constexpr double kStiffnessMax = 1e6;  // N/m
constexpr double kBendMax = 0.05;      // m

std::string refusal(double stiffness, double most, const std::string& remedy) {
  return fmt::format(
      "friction would hold with {:.4g} N/m, but this arm is free of limit cycles only up to {:.4g} "
      "N/m "
      "(sampling, delay and encoder steps); {}",
      stiffness, most, remedy);
}

}  // namespace

void CoulombSettings::read_sliding(SettingsReader& reader) {
  sliding = kCoefficient;
  reader.number("coefficient", sliding, {.unit = "", .max = kCoefficientMax});
  holding = sliding;
}

void CoulombSettings::read(SettingsReader& reader, double ratio) {
  read_sliding(reader);
  holding = ratio * sliding;
  reader.number("static_coefficient", holding, {.unit = "", .max = 2 * kCoefficientMax});
  if (holding < sliding) {
    reader.reject("static_coefficient", "must not be below coefficient, the sliding friction");
  }
}

void ViscousSettings::read(SettingsReader& reader) {
  reader.number("viscous", viscous, {.unit = "N s/m", .max = 20});
  reader.number("fade_depth", fade_depth, {.unit = "m", .max = 0.1});
}

double stick_stiffness_max(const EffectContext& context) {
  const double latency = context.tick / 2 + context.delay;
  const double sampled = (context.tip_damping + kHandDamping) / (kSafety * latency);
  const double counted = context.encoder_step > 0 && context.tip_coulomb > 0
                             ? 2 * context.tip_coulomb / context.encoder_step
                             : std::numeric_limits<double>::infinity();
  return std::min({sampled, counted, kStiffnessMax});
}

double read_stick_stiffness(SettingsReader& reader, const EffectContext& context, double holding) {
  const double most = stick_stiffness_max(context);
  constexpr double kAllowance = 1 + 1e-9;
  double stiffness = most;
  if (reader.has("stiffness") && reader.has("z_max")) {
    reader.reject("z_max", "cannot be combined with stiffness; remove one of them");
  } else if (reader.has("stiffness")) {
    reader.number("stiffness", stiffness, {.unit = "N/m", .min = 1, .max = kStiffnessMax});
    if (stiffness > kAllowance * most) {
      reader.reject("stiffness", refusal(stiffness, most, "lower it or remove it"));
    }
  } else if (reader.has("z_max")) {
    double bend = kBendMax;
    reader.number("z_max", bend, {.unit = "m", .min = 1e-9, .max = kBendMax});
    const double force = holding * context.force_max;
    stiffness = force / bend;
    if (!(force > 0)) {
      reader.reject("z_max",
                    "needs friction and an arm with a maximum force; set stiffness instead");
    } else if (stiffness > kAllowance * most) {
      const std::string least =
          fmt::format("expected z_max >= {:.3g} m, found {:.3g} m", force / most, bend);
      reader.reject("z_max", refusal(stiffness, most, least));
    }
  }
  return stiffness;
}

}  // namespace thimble::render
