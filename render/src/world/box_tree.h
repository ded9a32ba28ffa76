#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "world_solid.h"

namespace thimble::render {

/// Binary tree over the boxes of solids that do not move. One frame, m.
class BoxTree {
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

/// Returns the squared distance of a point from a box, m^2; 0 inside. Real-time: safe.
inline double squared_distance(const SolidBox& box, const Eigen::Vector3d& p) noexcept {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).squaredNorm();
}

}  // namespace thimble::render
