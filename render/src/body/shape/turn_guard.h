#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/contact_mesh.h"

namespace thimble::render {

/// Keeps the triangles of a mesh from turning over while their corners move by any distance. Seen
/// along its first normal, each triangle keeps a share of its first area
/// [BP 4.3: "problems when the model was deformed too much"]. It uses the present places of the
/// neighbours, so that a pit may be deeper than a triangle is wide.
class TurnGuard {
 public:
  /// Takes the mesh in its first shape. 32 bytes per triangle. Real-time: never from the servo
  /// thread.
  explicit TurnGuard(const ContactMesh& mesh);

  // All of the following are Real-time: safe; one area per triangle around the vertex.

  /// Returns the share (0 to 1) of the way from the place of `vertex` to `p_W` (m) that it may
  /// move, with all vertices at `places` (m). 0 for NaN.
  double allowed(const ContactMesh& mesh, std::span<const Eigen::Vector3d> places,
                 std::int32_t vertex, const Eigen::Vector3d& p_W) const noexcept;

  /// Receives that an edge was split: each half keeps its share of its own half of the first area.
  /// Memory is reserved for the maximum number of triangles.
  void take(const EdgeSplit& split) noexcept {
    for (const std::int32_t triangle : split.triangles) {
      Eigen::Vector3d& halved = seen_along_[static_cast<std::size_t>(triangle)];
      halved *= 2;
      seen_along_.push_back(halved);
    }
  }

  /// Returns a triangle's first outward normal; zero if it had no area.
  Eigen::Vector3d first_normal(std::int32_t triangle) const noexcept {
    return seen_along_[static_cast<std::size_t>(triangle)].stableNormalized();
  }

 private:
  // The first normal divided by twice the first area: its product with twice the present area
  // vector is the visible share.
  std::vector<Eigen::Vector3d> seen_along_;
};

}  // namespace thimble::render
