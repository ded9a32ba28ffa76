#pragma once

#include <string_view>

#include "surface/texture/texture_height.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/live_settings.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// Maximum slope of a texture. At 45 degrees the surface is twice as stiff along the slope as along
/// the normal; anything steeper is geometry and belongs in the mesh. [chosen]
inline constexpr double kTextureSlopeMax = 1;

/// Default speed of a hand up to which a texture keeps its spectral lines, m/s: a fast exploring
/// stroke. [chosen; scenes vary it]
inline constexpr double kTextureHandSpeed = 0.1;

/// Settings of all textures: form, and expected speed of the hand.
struct TextureSettings {
  TextureForm form = TextureForm::kConservative;  ///< Effect in addition to changing the depth.
  double hand_speed = kTextureHandSpeed;          ///< m/s

  /// Reads `form` and `hand_speed`. Real-time: never from the servo thread.
  void read(SettingsReader& reader);
};

/// Properties that decide whether a texture can be rendered correctly.
struct TextureExtent {
  double relief = 0;      ///< Height from its lowest to its highest place, m.
  double slope = 0;       ///< Maximum slope, or its root mean square for random textures.
  double wavelength = 0;  ///< Shortest wavelength, m.
};

/// Returns the factor (>= 1) by which a valid texture may be made higher, until it would be refused
/// or three times as high. Real-time: never from the servo thread.
double texture_headroom(const TextureExtent& extent, const EffectContext& context);

/// Bounds the change of the force with the factor g by which a texture is made higher. With the
/// depth d + g h it is k (d + g h) (n - g grad h). So its change is at most k |h| |n - g grad h|
/// and k (d + g h) |grad h| together. Real-time: never from the servo thread.
ForceSensitivity texture_lever(const TextureExtent& extent);

/// Returns the length of the shortest wave that the loop can render for a hand at `hand_speed`, m:
/// two ticks. Real-time: never from the servo thread.
double shortest_wave(const TextureSettings& settings, const EffectContext& context);

/// Refuses, with a message at `key`, a texture that is deeper than the arm's full force can press
/// into the surface, or steeper than kTextureSlopeMax. Also refuses one so fine that a hand at
/// `hand_speed` crosses more than half a wave per tick. Real-time: never from the servo thread.
void check_texture(SettingsReader& reader, std::string_view key, const TextureExtent& extent,
                   const TextureSettings& settings, const EffectContext& context);

}  // namespace thimble::render
