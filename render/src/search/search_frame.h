#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "compact_mesh/packed_surface.h"
#include "mesh/contact_mesh.h"

namespace thimble::render {

/// The frame of a search: steps of 2^-31 of the surface's longest side from the middle of its box,
/// so that results do not depend on scale or place. For a PackedSurface it is its lattice. The
/// conversion from W is monotone on each axis, rounding included. Real-time: safe.
struct SearchFrame {
  Eigen::Vector3d origin{0, 0, 0};  ///< m, W
  double step = 1;                  ///< m
  double per_step = 1;              ///< 1/m

  /// Converts a point (W, m) to steps of the frame. Real-time: safe.
  Eigen::Vector3d to_steps(const Eigen::Vector3d& p_W) const noexcept {
    return (p_W - origin) * per_step;
  }
};

/// Returns the frame of a surface. Real-time: safe.
SearchFrame frame_of(const PackedSurface& surface) noexcept;
SearchFrame frame_of(const ContactMesh& mesh) noexcept;

/// Returns the maximum number of triangles that a surface may grow to. Real-time: safe.
inline std::size_t room_of(const PackedSurface& surface) noexcept {
  return static_cast<std::size_t>(surface.triangle_count());
}
inline std::size_t room_of(const ContactMesh& mesh) noexcept {
  return mesh.triangles_max();
}

/// Returns the position of corner `k` of triangle `t` in steps of the frame. Searches read
/// positions only by this accessor. Real-time: safe.
inline Eigen::Vector3d corner_in(const SearchFrame&, const PackedSurface& surface, std::int32_t t,
                                 std::size_t k) noexcept {
  return surface.triangle(t).corner(k);
}
inline Eigen::Vector3d corner_in(const SearchFrame& frame, const ContactMesh& mesh, std::int32_t t,
                                 std::size_t k) noexcept {
  return frame.to_steps(mesh.position(t, k));
}

}  // namespace thimble::render
