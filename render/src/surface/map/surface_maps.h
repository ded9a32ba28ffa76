#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace thimble::render {

/// Function of the position on a triangle: slope * p + offset. It does not depend on the order of
/// the corners.
template <int kSize>
struct AffineValue {
  Eigen::Matrix<double, kSize, 3, Eigen::DontAlign> slope;   ///< 1/m
  Eigen::Matrix<double, kSize, 1, Eigen::DontAlign> offset;  ///< NaN: the triangle has no value.

  /// Returns whether the triangle has values. Real-time: safe.
  bool given() const noexcept { return slope.allFinite() && offset.allFinite(); }
};

/// Texture coordinates and vertex colours of the triangles of a touched mesh, as functions of the
/// position in its frame (m). Each list is empty, or has an entry per triangle.
struct SurfaceMaps {
  std::vector<AffineValue<2>> uv;       ///< Texture coordinates.
  std::vector<AffineValue<3>> colours;  ///< Red, green, blue.
  /// A point of each triangle, for messages.
  std::vector<Eigen::Vector3d> middles;
};

/// Returns the maps of a part of a mesh, which has these triangles. Real-time: never from the servo
/// thread.
inline SurfaceMaps part_of(const SurfaceMaps& maps, std::span<const std::int32_t> triangles) {
  SurfaceMaps part;
  for (const std::int32_t number : triangles) {
    const auto t = static_cast<std::size_t>(number);
    if (!maps.uv.empty()) part.uv.push_back(maps.uv[t]);
    if (!maps.colours.empty()) part.colours.push_back(maps.colours[t]);
    part.middles.push_back(maps.middles[t]);
  }
  return part;
}

}  // namespace thimble::render
