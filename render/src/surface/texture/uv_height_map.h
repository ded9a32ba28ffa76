#pragma once

#include <algorithm>
#include <memory>
#include <string_view>

#include "surface/map/map_follower.h"
#include "surface/map/surface_map.h"
#include "surface/texture/height_map.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/result.h"
#include "thimble/render/effect/effect_table.h"

namespace thimble::render {

/// A HeightMap whose picture lies on a mesh by its texture coordinates (`map: uv`). A
/// ClosestPointStage.
///
/// The gradient is that by the place on the surface in metres, from the texture coordinates of each
/// triangle. So a picture that is stretched in the file is felt stretched. Triangles without
/// texture coordinates, or with coordinates that have no area, are smooth and in the surface, as
/// white is. Where the height steps, at a seam at which the picture does not match, it is felt as a
/// slope of at most kTextureSlopeMax behind the seam (MapFollower). The slope turns so that the
/// force along the surface changes by at most stiffness times path: at the depth d by 1 / d per
/// metre. It is not finer than the loop can render (check_texture).
class UvHeightMap {
 public:
  static constexpr std::string_view kGroup = HeightMap::kGroup;
  static constexpr std::string_view kName = HeightMap::kName;
  static constexpr EffectOrder kOrder = HeightMap::kOrder;

  /// Returns the builder of the stage for the maps of a mesh. The error is that of SurfaceMap, or
  /// that of check_texture with the triangle that is too steep. Real-time: never from the servo
  /// thread.
  static driver::Result<StageBuilder> on(const std::shared_ptr<const SurfaceMaps>& maps,
                                         const HeightMap::Settings& settings,
                                         const EffectContext& context);

  /// Precondition: there is a map. Real-time: never from the servo thread.
  UvHeightMap(std::shared_ptr<const SurfaceMap> map, const HeightMap::Settings& settings,
              const EffectContext& context);

  /// See ClosestPointStage. Real-time: safe.
  void touch_at(const ClosestSurfacePoint& closest, const driver::DeviceState& state,
                SurfaceResponse& response) noexcept {
    const auto sample = [&](std::int32_t triangle, const Eigen::Vector3d& p_M) noexcept {
      return map_->at(triangle, p_M);
    };
    constexpr double kFlatTouch = 1e-9;  // m; a flatter map or touch is not felt [chosen]
    const double height = std::max(height_, kFlatTouch);
    const MapFollower::Felt felt =
        follower_.follow(state.p_WT, closest, response.contact.triangle,
                         sample(response.contact.triangle, closest.p_M), *map_, sample,
                         {.ramp = kTextureSlopeMax / height,
                          .bend = 1 / (height * std::max(response.contact.depth, kFlatTouch)),
                          .shortest = shortest_});
    // The gradient is by the tip already.
    ClosestSurfacePoint at_tip = closest;
    at_tip.J_MT.setIdentity();
    feel_height({.height = height_ * (felt.value - 1), .slope_M = height_ * felt.slope_W}, at_tip,
                form_, response);
  }
  /// The same on a flat surface. Real-time: safe.
  void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept {
    touch_at(flat_closest_point(response.contact), state, response);
  }
  void leave() noexcept { follower_.leave(); }

  const std::shared_ptr<const SurfaceMap>& map() const noexcept { return map_; }
  /// Returns the height of black below white, m.
  double height() const noexcept { return height_; }

  /// Lists the height. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings);

  /// Returns height and slope of a map on a mesh. Real-time: never from the servo thread.
  static TextureExtent extent_of(const SurfaceMap& map, const HeightMap::Settings& settings);

 private:
  std::shared_ptr<const SurfaceMap> map_;
  double height_;
  TextureExtent extent_;  // of the first height
  double max_height_;
  TextureForm form_;
  double shortest_;  // m, of a wave that the loop can render
  MapFollower follower_;
};

}  // namespace thimble::render
