#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::render {

/// Result of a contact algorithm for one tick. Frames: W world, P proxy.
struct ContactState {
  bool touching = false;          ///< True if the tip is in contact.
  std::int32_t triangle = -1;     ///< Active triangle, -1 if not touching.
  double depth = 0;               ///< Distance of the tip below the active surface along n_W, m.
  Eigen::Vector3d n_W{0, 0, 0};   ///< Outward unit normal.
  Eigen::Vector3d p_WP{0, 0, 0};  ///< Proxy: p_WT + depth * n_W, m.
  std::uint16_t hops = 0;         ///< Triangles crossed in this tick.
};

}  // namespace thimble::render
