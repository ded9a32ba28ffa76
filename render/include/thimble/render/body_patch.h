#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace thimble::render {

/// Triangles to draw for a dent instead of some triangles of the mesh [BP Fig. 6]. The touched
/// triangle is replaced by 6 and each of its neighbours by 2; other moving triangles are not split.
///
/// The renderer omits the mesh triangles listed in `source` and draws `triangles` instead. Both
/// have the same border, so the surface stays closed. Trivially copyable, for a snapshot between
/// threads or processes.
struct BodyPatch {
  static constexpr std::size_t kPointsMax = 768;      ///< Room for points.
  static constexpr std::size_t kTrianglesMax = 1280;  ///< Room for triangles.

  /// Corner of the triangles.
  struct Point {
    /// Position in the frame of the given mesh, m. Double precision, because the parts of thin
    /// triangles of scans could turn over by the rounding of single precision.
    std::array<double, 3> p{};
    /// Normal. Interpolate it over the triangle, then normalise. At the cursor and on edges it
    /// equals that of the undeformed triangle, so that mere contact changes no shading.
    std::array<float, 3> n{};
    std::int32_t vertex = -1;  ///< Vertex of the mesh; -1: the cursor or a point on an edge.
  };

  std::uint16_t point_count = 0;     ///< Number of points in use.
  std::uint16_t triangle_count = 0;  ///< Number of triangles in use.
  /// Object of the scene, numbered from 0; -1: nothing is dented.
  std::int16_t object = -1;
  /// False if the moving part does not fit; then draw the undeformed mesh only.
  bool complete = true;
  /// Fraction of the dent that is drawn: below 1 if the whole dent would turn a triangle over.
  float share = 1;
  std::array<Point, kPointsMax> points;  ///< Points of the patch.
  /// Indices of points, counter-clockwise from outside.
  std::array<std::array<std::uint16_t, 3>, kTrianglesMax> triangles;
  /// Triangle of the mesh to which each of `triangles` belongs.
  std::array<std::int32_t, kTrianglesMax> source;
};
static_assert(std::is_trivially_copyable_v<BodyPatch>);

}  // namespace thimble::render
