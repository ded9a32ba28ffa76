#include "mesh/segment_crossing.h"

#include "mesh/exact_sign.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Returns the side of the directed edge a-b on which the moved segment passes. The first-order
// change of the orientation under the move is -(e, e^2, e^3) . ((b - a) x (p_to - p_from)), so the
// first component that is not zero decides. Zero only if edge and segment are parallel: then no
// triangle of that edge is crossed.
int side_of_edge(const Vector3d& p_from, const Vector3d& p_to, const Vector3d& a,
                 const Vector3d& b) noexcept {
  if (const int side = orientation(p_from, p_to, a, b)) return side;
  for (int axis = 0; axis < 3; ++axis) {
    if (const int side = cross_sign(a, b, p_from, p_to, axis)) return -side;
  }
  return 0;
}

// Returns the side of a triangle's plane on which a moved point is; zero only if the triangle has
// no area.
int side_of_plane(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                  const Vector3d& p) noexcept {
  if (const int side = orientation(a, b, c, p)) return side;
  for (int axis = 0; axis < 3; ++axis) {
    if (const int side = cross_sign(a, b, a, c, axis)) return side;
  }
  return 0;
}

}  // namespace

Crossing crossing(const Vector3d& p_from, const Vector3d& p_to, const Vector3d& a,
                  const Vector3d& b, const Vector3d& c) noexcept {
  // Edges come first: on a flat part with the tip in its plane every plane test would need exact
  // arithmetic, while the edge tests leave few triangles.
  const int side = side_of_edge(p_from, p_to, a, b);
  if (side == 0 || side_of_edge(p_from, p_to, b, c) != side) return Crossing::kNone;
  if (side_of_edge(p_from, p_to, c, a) != side) return Crossing::kNone;
  const int from = side_of_plane(a, b, c, p_from);
  const int to = side_of_plane(a, b, c, p_to);
  if (from > 0 && to < 0) return Crossing::kEnters;
  if (from < 0 && to > 0) return Crossing::kLeaves;
  return Crossing::kNone;
}

}  // namespace thimble::render
