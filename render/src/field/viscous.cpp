#include "field/viscous.h"

#include <cstdio>
#include <limits>
#include <numbers>

namespace thimble::render {

void Viscous::Settings::read(SettingsReader& reader, const EffectSurroundings& surroundings) {
  reader.number("damping", damping, {.unit = "N s/m", .least = 0, .most = 1000, .required = true});
  const double late = surroundings.tick + surroundings.delay;
  const double most = most_damping(surroundings);
  if (!(damping <= most)) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "is %.4g N s/m, but a force that comes %.3g ms late swings an arm of %.3g kg up "
                  "beyond %.3g N s/m: make it thinner or the loop faster",
                  damping, 1e3 * late, surroundings.tip_mass, most);
    reader.reject("damping", text);
  }
}

double Viscous::most_damping(const EffectSurroundings& surroundings) {
  // Where the arm's mass is not known there is nothing to compare with.
  if (!(surroundings.tip_mass > 0)) return std::numeric_limits<double>::infinity();
  const double late = surroundings.tick + surroundings.delay;
  return std::numbers::pi / 2 * surroundings.tip_mass / late;
}

}  // namespace thimble::render
