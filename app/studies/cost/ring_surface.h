#pragma once

#include <Eigen/Core>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::studies {

/// A ring (torus) about the z axis of the world: a surface whose depth and normal are known at
/// every point, hollow on the inner side and round on the outer. m.
struct RingSurface {
  double ring_radius = 0.05;
  double tube_radius = 0.02;

  /// Finds the outward unit normal at the point of the ring nearest to `p_W`.
  Eigen::Vector3d normal(const Eigen::Vector3d& p_W) const noexcept;

  /// Finds how deep `p_W` lies below the ring's surface, m; negative outside.
  double depth(const Eigen::Vector3d& p_W) const noexcept;

  /// Returns a point at `height` (m) over the surface; angles in rad, `across` from the outer
  /// equator.
  Eigen::Vector3d at(double around, double across, double height) const noexcept;

  /// Cuts the ring into triangles. Real-time: never from the servo thread.
  render::TriangleMesh mesh(int around, int across) const;
};

/// Returns the states of a tip that strokes the ring for `ticks` ticks of `dt` (s): it comes from
/// outside, strokes forth and back at up to 80 mm/s, 0.5 to 1.5 mm deep, winding over the whole
/// tube, stops at each turn, and leaves. Without noise: the same each time.
/// Real-time: never from the servo thread.
std::vector<driver::DeviceState> ring_stroke(const RingSurface& ring, int ticks, double dt);

}  // namespace thimble::studies
