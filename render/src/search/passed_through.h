#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>

#include "mesh/triangle_set.h"
#include "search/contact_search.h"

namespace thimble::render {

/// The face that holds a tip behind a thin part, -1 for none.
struct FaceAbove {
  std::int32_t triangle = -1;
  double depth = 0;            ///< Depth of the tip below the face's plane.
  Eigen::Vector3d n{0, 0, 0};  ///< Unit normal of the face.
};

/// A part is thin if it is thinner than this share of the mesh's longest side. An arm cannot pass a
/// thicker part in one tick. [chosen]
inline constexpr double kThinPart = 0.05;

/// Faces that lean by more, as a cosine, are the rim of a part or its back: 84 degrees, so that the
/// rounding of a right angle does not decide. [chosen]
inline constexpr double kBeyondRim = 0.1;

/// Faces that lean by more, as a cosine, would push out a tip that is inside at the back (as in
/// SurfaceTracker).
inline constexpr double kPushesOutBehind = -0.25;

namespace passed_through_steps {

/// Maximum number of rounds. Each looks along the normal of the face found by the last one.
/// [chosen: flat parts take 2, curved ones 3; in a groove two faces lead to each other]
constexpr int kRounds = 8;

/// Maximum number of triangles that one round walks over.
constexpr std::size_t kStepsMax = 64;

/// Walks, seen along `n`, over faces that point the same way, to the one in front of `p`. Returns
/// -1 if the way leads over a rim or is too long.
template <class Faces>
std::int32_t in_front_of(const Faces& faces, std::int32_t from, const Eigen::Vector3d& p,
                         const Eigen::Vector3d& n) noexcept {
  TriangleSet<kStepsMax> visited;
  std::int32_t triangle = from;
  while (!visited.full()) {
    visited.add(triangle);
    const std::array<Eigen::Vector3d, 3> corners{
        faces.corner(triangle, 0), faces.corner(triangle, 1), faces.corner(triangle, 2)};
    std::int32_t next = -1;
    double worst = 0;
    bool outside = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d side = corners[(k + 1) % 3] - corners[k];
      const double beside = side.cross(p - corners[k]).dot(n) / side.norm();
      if (!(beside < 0)) continue;
      outside = true;
      const std::int32_t neighbour = faces.neighbour(triangle, k);
      // Back again only by rounding: the tip is on the edge.
      if (beside < worst && !visited.has(neighbour)) {
        worst = beside;
        next = neighbour;
      }
    }
    if (!outside || next < 0) return triangle;
    if (!(faces.normal(next).dot(n) > kBeyondRim)) return -1;
    triangle = next;
  }
  return -1;
}

}  // namespace passed_through_steps

/// Finds the face that has the tip `p` below it, seen along its normal. Goes over faces that point
/// the same way, starting at `from`: the triangle that held the tip in the last tick, or was
/// entered in this one. Returns none if the tip is past the rim or above the surface. A walk over
/// edges cannot find this face: near a rim it ends at the back of the part.
///
/// `faces` provides the surface: corner(t, k), normal(t), neighbour(t, k). One frame and unit.
/// Real-time: safe; at worst `kRounds` times `kStepsMax` triangles.
template <class Faces>
FaceAbove face_above(const Faces& faces, std::int32_t from, const Eigen::Vector3d& p) noexcept {
  using namespace passed_through_steps;
  FaceAbove deepest;
  std::int32_t triangle = from;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Vector3d n = faces.normal(triangle);
    const FaceAbove face{
        .triangle = triangle, .depth = n.dot(faces.corner(triangle, 0) - p), .n = n};
    const std::int32_t next = in_front_of(faces, triangle, p, n);
    if (next < 0) return {};
    if (next == triangle) return face.depth > 0 ? face : FaceAbove{};
    // Between the faces of a groove: the deepest of those that lead to each other, wherever the
    // walk begins.
    if (round >= kRounds / 2 && face.depth > deepest.depth) deepest = face;
    triangle = next;
  }
  return deepest;
}

/// Returns whether a thin part is between a tip outside the surface, at `p_WT`, and the face that
/// it is below by `depth` (m). `longest` is the mesh's longest side, m; `first_entry(from, to)` is
/// called once. Real-time: safe.
template <class FirstEntry>
bool behind_thin_part(const Eigen::Vector3d& p_WT, double depth, const Eigen::Vector3d& n_W,
                      double longest, const FirstEntry& first_entry) noexcept {
  // The way up to the face enters the part at its back.
  const Entry back = first_entry(p_WT, Eigen::Vector3d(p_WT + depth * n_W));
  // Written so that NaN counts as not behind.
  return back.triangle >= 0 && (1 - back.parameter) * depth < kThinPart * longest;
}

}  // namespace thimble::render
