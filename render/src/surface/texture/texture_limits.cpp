#include "surface/texture/texture_limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "math/elementary.h"

namespace thimble::render {

void TextureSettings::read(SettingsReader& reader) {
  auto chosen = static_cast<std::size_t>(form);
  reader.choice("form", chosen, {kTextureFormNames.begin(), kTextureFormNames.end()});
  form = static_cast<TextureForm>(chosen);
  // A hand is never faster than a few m/s.
  reader.number("hand_speed", hand_speed, {.unit = "m/s", .min = 1e-3, .max = 5});
}

double texture_headroom(const TextureExtent& extent, const EffectContext& context) {
  constexpr double kHeadroomMax = 3;  // chosen
  double headroom = kHeadroomMax;
  if (extent.slope > 0) headroom = std::min(headroom, kTextureSlopeMax / extent.slope);
  if (extent.relief > 0 && context.surface_stiffness > 0) {
    headroom = std::min(headroom, context.force_max / context.surface_stiffness / extent.relief);
  }
  return std::max(headroom, 1.0);
}

ForceSensitivity texture_lever(const TextureExtent& extent) {
  return {.per_force = extent.slope,
          .per_stiffness = extent.relief * math::hypot(1, kTextureSlopeMax)};
}

double shortest_wave(const TextureSettings& settings, const EffectContext& context) {
  return 2 * settings.hand_speed * context.tick;
}

void check_texture(SettingsReader& reader, std::string_view key, const TextureExtent& extent,
                   const TextureSettings& settings, const EffectContext& context) {
  const double deepest =
      context.surface_stiffness > 0 ? context.force_max / context.surface_stiffness : 0;
  // If arm or spring is not known, there is nothing to compare with.
  if (deepest > 0 && !(extent.relief <= deepest)) {
    reader.reject(
        key, fmt::format("is {:.3g} mm from peak to valley, but the arm's {:.3g} N press only "
                         "{:.3g} mm deep into {:.4g} N/m; make it flatter or the surface softer",
                         1e3 * extent.relief, context.force_max, 1e3 * deepest,
                         context.surface_stiffness));
  }
  if (!(extent.slope <= kTextureSlopeMax)) {
    reader.reject(
        key,
        fmt::format(
            "has a slope of {:.3g}, above the maximum {:.3g}; make it flatter or its waves longer",
            extent.slope, kTextureSlopeMax));
  }
  const double frequency = settings.hand_speed / extent.wavelength;
  const double highest = 0.5 / context.tick;
  if (!(frequency <= highest)) {
    reader.reject(key, fmt::format("has waves of {:.3g} mm, which a hand at {:.3g} m/s feels as "
                                   "{:.4g} Hz; a loop of {:.4g} "
                                   "Hz displays {:.4g} Hz at most; make the waves longer, the loop "
                                   "faster or hand_speed smaller",
                                   1e3 * extent.wavelength, settings.hand_speed, frequency,
                                   1 / context.tick, highest));
  }
}

}  // namespace thimble::render
