#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace thimble::render {

/// What is drawn of a dent: triangles that stand in for some of the mesh's [BP Fig. 6]. The
/// touched one is drawn as 6, each of its neighbours as 2, what else moves as it is.
///
/// Whoever draws leaves out the mesh's triangles named in `source` and draws `triangles` in their
/// place: both have the same border, so the surface stays closed. Trivially copyable, for a
/// snapshot between threads or processes.
struct BodyPatch {
  static constexpr std::size_t kPointsMax = 768;      ///< Room for points.
  static constexpr std::size_t kTrianglesMax = 1280;  ///< Room for triangles.

  /// One corner of the triangles.
  struct Point {
    /// m, in the frame the mesh is given in; in double, since scans have slivers whose parts would
    /// turn over by the rounding of single precision.
    std::array<double, 3> p{};
    /// Normal: interpolate it over the triangle and make it unit then. At the cursor and on edges
    /// it is what the untouched triangle has there, so that touching alone changes no shade.
    std::array<float, 3> n{};
    std::int32_t vertex = -1;  ///< Of the mesh; -1: the cursor or a point on an edge.
  };

  std::uint16_t point_count = 0;     ///< How many are in use.
  std::uint16_t triangle_count = 0;  ///< How many are in use.
  std::int16_t object = -1;          ///< Of the scene, counted from 0; -1: nothing is dented.
  /// False if more moves than fits: nothing is drawn then but the mesh as it was.
  bool complete = true;
  /// How much of the dent is drawn: below 1 where all of it would turn a triangle over.
  float share = 1;
  std::array<Point, kPointsMax> points;  ///< Its points.
  /// Numbers of points, counter-clockwise from outside.
  std::array<std::array<std::uint16_t, 3>, kTrianglesMax> triangles;
  /// The mesh's triangle that each of `triangles` is, or is a part of.
  std::array<std::int32_t, kTrianglesMax> source;
};
static_assert(std::is_trivially_copyable_v<BodyPatch>);

}  // namespace thimble::render
