#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "world_solid.h"

namespace thimble::render {

/// Returns the squared distance of a point from a box, m^2; 0 inside. Real-time: safe.
inline double squared_distance(const SolidBox& box, const Eigen::Vector3d& p) noexcept {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).squaredNorm();
}

/// Binary tree over the boxes of solids that do not move. One frame, m.
class BoxTree {
  // Halves of 2^31 boxes end after 31 levels; each leaves one node waiting.
  static constexpr std::size_t kWaitingMax = 64;

 public:
  /// Builds the tree over the boxes of `solids`; box i belongs to solid i. Real-time: never from
  /// the servo thread.
  BoxTree(std::vector<SolidBox> boxes, std::vector<std::int32_t> solids);

  /// Writes the numbers of all boxes that are nearer to `p` than `radius` to `found`, in ascending
  /// order. Returns false, with part of them, if there are more than `count_max`, or more than
  /// `found` has reserved. NaN finds nothing. Real-time: safe; grows with the number found and the
  /// depth of the tree.
  bool near(const Eigen::Vector3d& p, double radius, std::size_t count_max,
            std::vector<std::int32_t>& found) const noexcept;

  /// Returns whether `holds(solid)` is true for a solid whose box contains `p`. Real-time: safe if
  /// `holds` is.
  template <class Holds>
  bool any_at(const Eigen::Vector3d& p, const Holds& holds) const noexcept {
    std::array<std::int32_t, kWaitingMax> waiting;
    std::size_t size = 0;
    if (!nodes_.empty()) waiting[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[static_cast<std::size_t>(waiting[--size])];
      // Written so that NaN is nowhere.
      if (!(squared_distance(node.box, p) <= 0)) continue;
      if (node.solid < 0) {
        waiting[size++] = node.right;
        waiting[size++] = node.left;
      } else if (holds(node.solid)) {
        return true;
      }
    }
    return false;
  }

  /// Returns the distance to the nearest box, 0 inside one; infinite without boxes. Real-time:
  /// safe.
  double distance(const Eigen::Vector3d& p) const noexcept;

  /// Returns the box of a solid.
  const SolidBox& box(std::int32_t solid) const noexcept {
    return boxes_[static_cast<std::size_t>(solid)];
  }

 private:
  struct Node {
    SolidBox box;
    std::int32_t left = -1;  // node; the right one follows its subtree
    std::int32_t right = -1;
    std::int32_t solid = -1;  // of a leaf
  };
  std::int32_t build(std::span<std::int32_t> solids);

  std::vector<SolidBox> boxes_;
  std::vector<Node> nodes_;
};

}  // namespace thimble::render
