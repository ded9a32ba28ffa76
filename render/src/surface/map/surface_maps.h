#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"

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

/// Returns the maps of a touched mesh that was made from another one by a repair. `source_W` are
/// the vertices of the other mesh at their place in the world (m), `triangles` and `attributes` as
/// in its file. `origins` has the number of the source triangle of each touched one (RepairedMesh),
/// or -1 for none. Real-time: never from the servo thread.
THIMBLE_EXPORT SurfaceMaps surface_maps_of(std::span<const Eigen::Vector3d> source_W,
                                           std::span<const std::array<std::int32_t, 3>> triangles,
                                           const MeshAttributes& attributes,
                                           std::span<const std::int32_t> origins);

/// Returns the maps of a part of a mesh, which has these triangles. Real-time: never from the servo
/// thread.
SurfaceMaps part_of(const SurfaceMaps& maps, std::span<const std::int32_t> triangles);

}  // namespace thimble::render
