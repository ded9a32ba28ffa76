#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "surface/height_image.h"
#include "surface/map/surface_maps.h"
#include "thimble/driver/result.h"

namespace thimble::render {

/// A quantity from 0 (black) to 1 (white) over the surface of a mesh: the grey value of a picture
/// by texture coordinates, or one of the vertex colours.
class SurfaceMap {
 public:
  /// Treatment of triangles without a value.
  enum class Missing : std::uint8_t {
    kRefused,  ///< An error.
    /// They have the value 1 and no slope; so do triangles whose texture coordinates have no area.
    kWhite,
  };

  /// Value and gradient at a place.
  struct Sample {
    double value = 1;                  ///< 0 to 1
    Eigen::Vector3d slope_M{0, 0, 0};  ///< 1/m
  };

  /// Builds the map of a picture, repeated in both directions, by the texture coordinates of a
  /// mesh. `user` names what needs it, for messages ("stiffness_map"). The error states which
  /// coordinates are missing. Real-time: never from the servo thread.
  static driver::Result<std::shared_ptr<const SurfaceMap>> of_image(
      std::shared_ptr<const SurfaceMaps> maps, std::shared_ptr<const HeightImage> image,
      Missing missing, const std::string& user);

  /// Builds the map of a vertex colour: 0 red, 1 green, 2 blue. Every triangle must have one.
  /// Real-time: never from the servo thread.
  static driver::Result<std::shared_ptr<const SurfaceMap>> of_colour(
      std::shared_ptr<const SurfaceMaps> maps, std::size_t channel, const std::string& user);

  /// Returns the sample at a place (m, in the frame of the mesh) on a triangle, or next to it in
  /// its plane. NaN gives NaN; a triangle that does not exist has the value 1. Real-time: safe; 16
  /// pixels.
  Sample at(std::int32_t triangle, const Eigen::Vector3d& p_M) const noexcept;

  /// Returns whether the map is continuous from one triangle to the next one, near the place `p_M`
  /// (m) that was reached over `path` (m) of the surface. At a seam the two triangles continue with
  /// different places of the picture, or colours; a difference that the path explains is none.
  /// NaN is a seam. Real-time: safe.
  bool continues(std::int32_t before, std::int32_t triangle, const Eigen::Vector3d& p_M,
                 double path) const noexcept;

  /// Returns a bound of the gradient's size on any triangle, 1/m.
  double slope_max() const noexcept { return slope_max_; }
  /// Returns the shortest side of a pixel on any triangle, m; 0 for colours.
  double pixel_min() const noexcept { return pixel_min_; }
  /// Returns the triangle with the largest bound, as a place in a message ("triangle 3 near
  /// (...)").
  const std::string& steepest() const noexcept { return steepest_; }

 private:
  SurfaceMap() = default;

  std::shared_ptr<const SurfaceMaps> maps_;
  std::shared_ptr<const HeightImage> image_;  // null: colours
  std::size_t channel_ = 0;
  std::vector<bool> white_;  // triangles without a value; empty: none
  double slope_max_ = 0;
  double pixel_min_ = 0;
  std::string steepest_;
};

}  // namespace thimble::render
