#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "surface/texture/texture_limits.h"
#include "surface/texture/wave_sum.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_table.h"

namespace thimble::render {

/// A texture of sine waves of several amplitudes, lengths and directions, which change the
/// effective depth [BP 4.2]. A ClosestPointStage.
///
/// Sliding at speed v along a wave of length L, the force has a spectral line at v / L with the
/// amplitude stiffness * amplitude. All textures: texture_height.h.
class THIMBLE_EXPORT Sines {
 public:
  static constexpr std::string_view kGroup = "texture";
  static constexpr std::string_view kName = "sines";
  static constexpr EffectOrder kOrder = EffectOrder::kDepth;

  struct Settings : TextureSettings {
    /// One wave.
    struct One {
      double amplitude = 0;                ///< Half the distance from valley to peak, m.
      double wavelength = 0;               ///< m
      Eigen::Vector3d direction{1, 0, 0};  ///< Direction of the wave, in the object's frame.
      double phase = 0;                    ///< Phase at the object's place, rad.
    };
    std::vector<One> waves;  ///< All waves.

    /// Reads `form`, `hand_speed` and the list `waves`: amplitude, wavelength or frequency (waves
    /// per metre), direction, phase. Real-time: never from the servo thread.
    void read(SettingsReader& reader, const EffectContext& context);
    /// Returns their total height and slope. Precondition: each has a length. Real-time: safe.
    TextureExtent extent() const noexcept;
  };

  /// Real-time: never from the servo thread.
  Sines(const Settings& settings, const EffectContext& context);

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

  /// Lists the height of all waves, as a factor. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings);

  const WaveSum& height() const noexcept { return height_; }  ///< Returns the waves.

 private:
  void set_gain(double gain) noexcept;

  WaveSum height_;
  TextureForm form_;
  double gain_ = 1;
  double max_gain_;
  TextureExtent extent_;  // at a gain of 1
};

}  // namespace thimble::render
