#pragma once

#include <string_view>

#include "surface/texture/texture_limits.h"
#include "surface/texture/wave_sum.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_table.h"

namespace thimble::render {

/// A rough surface that catches the tip sideways, by the slope of a random height
/// [BP 4.2: the sandpaper system]. A ClosestPointStage.
///
/// The height is a sum of plane waves in random directions with lengths in one octave around the
/// wavelength, the same for the same seed on every machine. So it has no waves shorter than
/// wavelength / sqrt 2 and is smooth. All textures: texture_height.h.
class THIMBLE_EXPORT Sandpaper {
 public:
  static constexpr std::string_view kGroup = "texture";
  static constexpr std::string_view kName = "sandpaper";
  static constexpr EffectOrder kOrder = EffectOrder::kDepth;

  struct Settings : TextureSettings {
    double wavelength = 0.002;   ///< Middle wavelength, m.
    double roughness = 0.00003;  ///< Root mean square of the height, m.
    double seed = 1;             ///< An integer; each seed gives another piece of sandpaper.

    /// Reads `form`, `hand_speed`, `wavelength`, `roughness`, `seed`.
    /// Real-time: never from the servo thread.
    void read(SettingsReader& reader, const EffectContext& context);
    /// Returns its height and slope. Real-time: safe.
    TextureExtent extent() const noexcept;
  };

  /// Real-time: never from the servo thread.
  Sandpaper(const Settings& settings, const EffectContext& context);

  /// See ClosestPointStage. Real-time: safe.
  void touch_at(const ClosestSurfacePoint& closest, const driver::DeviceState&,
                SurfaceResponse& response) const noexcept {
    feel_height(height_.at(closest.p_M), closest, form_, response);
  }
  /// The same on a flat surface. Real-time: safe.
  void touch(const driver::DeviceState& state, SurfaceResponse& response) const noexcept {
    touch_at(flat_closest_point(response.contact), state, response);
  }
  void leave() const noexcept {}

  /// Lists the roughness. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings);

  const WaveSum& height() const noexcept { return height_; }  ///< Returns its waves.

 private:
  void set_roughness(double roughness) noexcept;

  WaveSum height_;
  TextureForm form_;
  double roughness_;      // m
  double max_roughness_;  // m
  TextureExtent extent_;  // of the first roughness
};

}  // namespace thimble::render
