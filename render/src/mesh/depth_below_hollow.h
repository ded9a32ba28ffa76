#pragma once

namespace thimble::render {

/// Returns the depth below a smooth surface that lies `gap` (> 0) below its triangles, for a tip
/// `below_mesh` (>= 0) below those, in the same unit: exact from twice the gap on; before that it
/// is softer, with the same depth and slope at the end, so that nobody who is inside is without
/// force. Real-time: safe.
inline double depth_below_hollow(double below_mesh, double gap) noexcept {
  return below_mesh < 2 * gap ? below_mesh * below_mesh / (4 * gap) : below_mesh - gap;
}

}  // namespace thimble::render
