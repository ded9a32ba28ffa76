#pragma once

#include <string_view>

#include "surface/texture/texture_height.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/live_settings.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// How steep a texture may be: at 45 degrees the surface is twice as stiff along the slope as
/// along the normal; what is steeper is geometry and belongs into the mesh. [chosen]
inline constexpr double kTextureSlopeMax = 1;

/// The speed of a hand up to which a texture keeps its lines, unless a scene says otherwise,
/// m/s: a fast exploring stroke. [chosen; scenes vary it]
inline constexpr double kTextureHandSpeed = 0.1;

/// What all textures may be asked: how they push, and how fast the hand is expected to be.
struct TextureSettings {
  TextureForm form = TextureForm::kConservative;  ///< What it does besides.
  double hand_speed = kTextureHandSpeed;          ///< m/s

  /// Reads `form` and `hand_speed`. Real-time: never from the servo thread.
  void read(SettingsReader& reader);
};

/// What decides whether a texture can be felt as it is meant.
struct TextureExtent {
  double relief = 0;      ///< From its lowest to its highest place, m.
  double slope = 0;       ///< The steepest, or its root mean square where it is random.
  double wavelength = 0;  ///< The shortest, m.
};

/// Returns by which factor (>= 1) a texture that was found right may be made higher, until it would
/// be refused or three times as high. Real-time: never from the servo thread.
double texture_headroom(const TextureExtent& extent, const EffectContext& context);

/// Bounds how the force changes with the factor by which a texture is made higher. With the depth
/// d + g h it is k (d + g h) (n - g grad h), so its change is at most k |h| |n - g grad h| and
/// k (d + g h) |grad h| together. Real-time: never from the servo thread.
ForceSensitivity texture_lever(const TextureExtent& extent);

/// Refuses, in a sentence at `key`, a texture that is deeper than the arm's whole force can press
/// into the surface, steeper than kTextureSlopeMax, or so fine that a hand at `hand_speed` runs
/// over more than half a wave per tick. Real-time: never from the servo thread.
void check_texture(SettingsReader& reader, std::string_view key, const TextureExtent& extent,
                   const TextureSettings& settings, const EffectContext& context);

}  // namespace thimble::render
