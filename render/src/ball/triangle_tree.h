#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mesh/contact_mesh.h"
#include "thimble/driver/export.h"
#include "world_solid.h"

namespace thimble::render {

/// A triangle and its distance from a point, m.
struct NearTriangle {
  std::int32_t triangle = -1;
  double distance = 0;
};

/// Binary tree over the triangles of a mesh at rest, for queries with a radius. Any number of
/// contacts may share it. W, m.
class THIMBLE_EXPORT TriangleTree {
 public:
  /// Builds the tree. Real-time: never from the servo thread.
  explicit TriangleTree(std::shared_ptr<const ContactMesh> mesh);

  const ContactMesh& mesh() const noexcept { return *mesh_; }

  /// Writes the triangles no farther than `radius` from `p` to `found`, nearest first, and their
  /// number to `count`. If there are more than `found` holds, they are the nearest ones. Returns
  /// the radius within which the list is complete. NaN finds nothing. Real-time: safe; grows with
  /// the number found.
  double near(const Eigen::Vector3d& p, double radius, std::span<NearTriangle> found,
              std::size_t& count) const noexcept;

  /// Returns the distance to the nearest triangle if it is below `bound`, else `bound`. Real-time:
  /// safe.
  double distance(const Eigen::Vector3d& p, double bound) const noexcept;

  /// Calls `visit(triangle)` for all triangles that may be nearer than `radius` to a path, and for
  /// others. Real-time: safe if `visit` is.
  template <class Visit>
  void along(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
             const Visit& visit) const noexcept;

 private:
  // A leaf has triangles `first` to `first + count`; the left node of others follows them.
  struct Node {
    SolidBox box;
    std::int32_t first = 0;
    std::int32_t count = 0;  // 0: not a leaf
    std::int32_t right = -1;
  };
  // Halves of 2^31 triangles end after 31 levels; each leaves one node waiting.
  static constexpr std::size_t kWaitingMax = 64;

  std::int32_t build(std::span<std::int32_t> triangles, std::int32_t first);
  // Calls `visit(triangle)` in the boxes nearer than `bound()`, the nearer ones first.
  template <class Bound, class Visit>
  void descend(const Eigen::Vector3d& p, const Bound& bound, const Visit& visit) const noexcept;

  std::shared_ptr<const ContactMesh> mesh_;
  std::vector<std::int32_t> triangles_;
  std::vector<Node> nodes_;
};

template <class Visit>
void TriangleTree::along(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
                         const Visit& visit) const noexcept {
  const Eigen::Vector3d way = to - from;
  // Whether the path meets a box that is larger by the radius on all sides.
  const auto meets = [&](const SolidBox& box) {
    double in = 0, out = 1;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double low = box.min[axis] - radius - from[axis];
      const double high = box.max[axis] + radius - from[axis];
      if (way[axis] == 0) {
        if (!(low <= 0 && high >= 0)) return false;
        continue;
      }
      const double a = low / way[axis], b = high / way[axis];
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    // With a margin for the rounding of the shares.
    return in <= out + 0x1p-40;
  };
  std::array<std::int32_t, kWaitingMax> waiting;
  std::size_t size = 0;
  if (!nodes_.empty()) waiting[size++] = 0;
  while (size > 0) {
    const std::int32_t number = waiting[--size];
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    if (!meets(node.box)) continue;
    for (std::int32_t i = 0; i < node.count; ++i) {
      visit(triangles_[static_cast<std::size_t>(node.first + i)]);
    }
    if (node.count > 0) continue;
    waiting[size++] = node.right;
    waiting[size++] = number + 1;
  }
}

}  // namespace thimble::render
