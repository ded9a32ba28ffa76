#pragma once

namespace thimble::render {

/// Returns the depth below a concave smooth surface `gap` (> 0) below its triangles, for a tip
/// `below_mesh` (>= 0) below the triangles, in the same unit. Exact from twice the gap on. Before
/// that it is softer, with the same depth and slope at the join, so that a tip inside always has a
/// force. Real-time: safe.
inline double depth_below_concave(double below_mesh, double gap) noexcept {
  return below_mesh < 2 * gap ? below_mesh * below_mesh / (4 * gap) : below_mesh - gap;
}

/// Derivatives of `depth_below_concave`.
struct ConcaveDepthChange {
  double per_depth = 1;  ///< By the depth below the triangles.
  double per_gap = -1;   ///< By the gap.
};

/// Returns the derivatives at the same place. Real-time: safe.
inline ConcaveDepthChange change_below_concave(double below_mesh, double gap) noexcept {
  if (!(below_mesh < 2 * gap)) return {};
  const double part = below_mesh / (2 * gap);
  return {.per_depth = part, .per_gap = -part * part};
}

}  // namespace thimble::render
