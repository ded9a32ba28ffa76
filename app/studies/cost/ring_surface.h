#pragma once

#include <Eigen/Core>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::studies {

/// A ring (torus) about the z axis of the world: a surface with known depth and normal at every
/// point, concave on the inner side and convex on the outer. m.
struct RingSurface {
  double ring_radius = 0.05;
  double tube_radius = 0.02;

  /// Returns the outward unit normal at the point of the ring closest to `p_W`.
  Eigen::Vector3d normal(const Eigen::Vector3d& p_W) const noexcept;

  /// Returns the depth of `p_W` below the ring's surface, m; negative outside.
  double depth(const Eigen::Vector3d& p_W) const noexcept;

  /// Returns a point at `height` (m) above the surface; angles in rad, `across` from the outer
  /// equator.
  Eigen::Vector3d at(double around, double across, double height) const noexcept;

  /// Returns the ring as triangles. Real-time: never from the servo thread.
  render::TriangleMesh mesh(int around, int across) const;
};

/// Returns the states of a tip that strokes the ring for `ticks` ticks of `dt` (s). The tip comes
/// from outside, strokes forth and back over the whole tube, stops at each turn, and leaves. Its
/// speed is up to 80 mm/s, its depth 0.5 to 1.5 mm. There is no noise: the states are identical
/// each time.
/// Real-time: never from the servo thread.
std::vector<driver::DeviceState> ring_stroke(const RingSurface& ring, int ticks, double dt);

}  // namespace thimble::studies
