#include "field/viscous.h"

#include <fmt/core.h>

#include <limits>
#include <numbers>

namespace thimble::render {

void Viscous::Settings::read(SettingsReader& reader, const EffectContext& context) {
  reader.number("damping", damping, {.unit = "N s/m", .min = 0, .max = 1000, .required = true});
  const double late = context.tick + context.delay;
  const double most = max_damping(context);
  if (!(damping <= most)) {
    reader.reject(
        "damping",
        fmt::format("is {:.4g} N s/m; with a force delay of {:.3g} ms, an arm of "
                    "{:.3g} kg oscillates above {:.3g} N s/m; lower it or run the loop faster",
                    damping, 1e3 * late, context.tip_mass, most));
  }
}

double Viscous::max_damping(const EffectContext& context) {
  // If the arm's mass is not known, there is nothing to compare with.
  if (!(context.tip_mass > 0)) return std::numeric_limits<double>::infinity();
  const double late = context.tick + context.delay;
  return std::numbers::pi / 2 * context.tip_mass / late;
}

}  // namespace thimble::render
