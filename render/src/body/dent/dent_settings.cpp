#include "thimble/render/body/dent_settings.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace thimble::render {
namespace {

// Bounds catch misplaced decimal points; they are far outside the range of a desk-top arm
// [DEVICES 3].
constexpr double kMassMin = 1e-6;      // kg per vertex
constexpr double kMassMax = 10;        // kg
constexpr double kStiffnessMax = 1e5;  // N/m
constexpr double kDampingMax = 1000;   // N s/m
constexpr int kSubstepsMax = 64;       // as in SpringMotionOptions
constexpr int kRoundsMax = 100;

// Schemes that can step nodes joined by springs, on a patch that changes.
constexpr std::array kSchemes{SpringScheme::kSymplecticEuler, SpringScheme::kVerlet,
                              SpringScheme::kImplicitEuler, SpringScheme::kTrapezoid};

void read_whole(SettingsReader& reader, std::string_view key, int& value, double least,
                double most) {
  double number = value;
  reader.number(key, number, {.unit = "", .min = least, .max = most, .whole = true});
  value = static_cast<int>(number);
}

}  // namespace

void DentSettings::read(SettingsReader& reader, const EffectContext& context) {
  step = context.tick;
  reader.number("mass", mass, {.unit = "kg", .min = kMassMin, .max = kMassMax});
  reader.number("stiffness", stiffness, {.unit = "N/m", .min = 0.001, .max = kStiffnessMax});
  reader.number("damping", damping, {.unit = "N s/m", .min = 0, .max = kDampingMax});
  reader.number("neighbour_stiffness", neighbour_stiffness,
                {.unit = "N/m", .min = 0, .max = kStiffnessMax});
  reader.number("neighbour_damping", neighbour_damping,
                {.unit = "N s/m", .min = 0, .max = kDampingMax});
  reader.number("reach", reach, {.unit = "", .min = 0.01, .max = 100});
  reader.number("pull", pull, {.unit = "", .min = 0, .max = 1});
  std::size_t region = whole ? 1 : 0;
  reader.choice("region", region, {"near", "whole"});
  whole = region == 1;
  if (whole && reader.has("rings")) {
    reader.reject("rings", "cannot be combined with region: whole; remove one of them");
  } else {
    read_whole(reader, "rings", rings, 0, kRingsMax);
  }
  std::size_t scheme = 0;
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < kSchemes.size(); ++i) {
    names.push_back(name_of(kSchemes[i]));
    if (kSchemes[i] == integrator) scheme = i;
  }
  reader.choice("integrator", scheme, names);
  integrator = kSchemes[scheme];
  read_whole(reader, "substeps", substeps, 1, kSubstepsMax);
  read_whole(reader, "rounds", rounds, 1, kRoundsMax);
}

driver::Result<void> DentSettings::check() const {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  const auto usable = [](double x) { return x >= 0 && std::isfinite(x); };
  const auto refuse = [](const std::string& why) { return driver::Error{"A dent needs " + why}; };
  if (!positive(mass)) return refuse("a mass above 0 kg per vertex.");
  if (!positive(stiffness))
    return refuse("a stiffness above 0 N/m; without it, the surface never returns.");
  if (!usable(damping) || !usable(neighbour_stiffness) || !usable(neighbour_damping)) {
    return refuse("finite dampings and a finite neighbour_stiffness of 0 or more.");
  }
  if (!positive(reach)) return refuse("a reach above 0.");
  if (!(pull >= 0 && pull <= 1)) return refuse("a pull from 0 to 1.");
  if (rings < 0 || rings > kRingsMax) return refuse("0 to 8 rings.");
  if (!positive(step)) return refuse("a time step above 0 s.");
  if (substeps < 1 || rounds < 1 || !(remainder >= 0)) {
    return refuse("at least one substep and one round, and a remainder of 0 or more.");
  }
  if (integrator == SpringScheme::kExplicitEuler) {
    return refuse(
        "an integrator other than explicit_euler, which gains energy from the cursor's "
        "springs (see thimble study integrators).");
  }
  if (integrator == SpringScheme::kExponential || integrator == SpringScheme::kModal) {
    return refuse(std::string("an integrator for a patch that moves with the tip; ") +
                  std::string(name_of(integrator)) + " needs a fixed set of nodes.");
  }
  return {};
}

}  // namespace thimble::render
