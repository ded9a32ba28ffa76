#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "surface/height_image.h"
#include "surface/texture/texture_limits.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_table.h"

namespace thimble::render {

/// A texture from a grey picture: white is in the object's surface, black deepest below. A
/// ClosestPointStage.
///
/// The picture is projected in the object's frame, along one axis or along all three at once, each
/// weighted by the square of the normal's component along it. It repeats. Projected along all axes,
/// it has the same orientation on every face, seen from outside; along one axis, as seen from that
/// axis' tip. On flat faces that is conservative. Where a curved face turns from one axis to the
/// next, the change of the weights is neglected: about (height / radius of curvature) of the force.
/// All textures: texture_height.h.
class THIMBLE_EXPORT HeightMap {
 public:
  static constexpr std::string_view kGroup = "texture";
  static constexpr std::string_view kName = "height_map";
  static constexpr EffectOrder kOrder = EffectOrder::kDepth;

  /// Axes of the object along which the image is projected: on every face from its own side, or
  /// only from one side.
  enum class Along : std::uint8_t { kAll, kX, kY, kZ };

  /// Place of the image on the surface.
  enum class Mapping : std::uint8_t {
    kProjected,  ///< Projected along axes.
    kUv,         ///< By the texture coordinates of the mesh (uv_height_map.h).
  };

  struct Settings : TextureSettings {
    std::shared_ptr<const HeightImage> image;  ///< Its heights.
    double width = 0;                          ///< Width of the picture on the surface, m.
    double height = 0;                         ///< Height from black to white, m.
    Along along = Along::kAll;                 ///< Axes of projection.
    Mapping map = Mapping::kProjected;         ///< Place of the image on the surface.

    /// Reads `form`, `hand_speed`, `map`, `image`, `height` and, if projected, `width` and `along`.
    /// Real-time: never from the servo thread.
    void read(SettingsReader& reader, const EffectContext& context);
    /// Returns its height and slope. Precondition: it has an image and a width. Real-time: safe.
    TextureExtent extent() const noexcept;
  };

  /// Returns the builder of the stage for the chosen mapping. Real-time: never from the servo
  /// thread.
  static StageBuilder builder(const Settings& settings, const EffectContext& context);

  /// Precondition: there is an image. Real-time: never from the servo thread.
  HeightMap(const Settings& settings, const EffectContext& context);

  /// See ClosestPointStage. Real-time: safe.
  void touch_at(const ClosestSurfacePoint& closest, const driver::DeviceState&,
                SurfaceResponse& response) const noexcept {
    feel_height(at(closest.p_M, closest.n_M), closest, form_, response);
  }
  /// The same on a flat surface. Real-time: safe.
  void touch(const driver::DeviceState& state, SurfaceResponse& response) const noexcept {
    touch_at(flat_closest_point(response.contact), state, response);
  }
  void leave() const noexcept {}

  /// Lists the height. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings);

  /// Returns the height at a place (M, m) of a surface with the normal `n_M`. NaN gives NaN.
  /// Real-time: safe; 16 pixels for each axis with a weight.
  TextureHeight at(const Eigen::Vector3d& p_M, const Eigen::Vector3d& n_M) const noexcept;

 private:
  std::shared_ptr<const HeightImage> image_;
  Eigen::Matrix3d R_WO_;
  Eigen::Vector3d p_WO_;
  double pixels_per_metre_;
  double height_;
  double max_height_ = 0;
  TextureExtent extent_;  // of the first height
  Along along_;
  TextureForm form_;
};

}  // namespace thimble::render
