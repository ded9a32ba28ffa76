#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "disk_paging/page_file.h"

namespace thimble::render {

/// Finds the boxes that a region reaches: a complete binary tree over boxes whose numbers are close
/// if they are near each other. All lengths in steps of the lattice. Queries are Real-time: safe.
class PageTree {
 public:
  /// Builds the tree. Real-time: never from the servo thread.
  explicit PageTree(std::span<const PageBox> boxes);

  /// Calls `visit(number)` for each box that the box from `low` to `high` reaches, in ascending
  /// order, until it returns false. NaN reaches nothing.
  template <class Visit>
  void visit_reached(const Eigen::Vector3d& low, const Eigen::Vector3d& high, Visit visit) const {
    // At most one branch of each level waits, and a complete tree of 2^31 boxes has 31 levels.
    std::array<std::size_t, 64> waiting;
    std::size_t count = 0;
    waiting[count++] = 1;
    while (count > 0) {
      const std::size_t node = waiting[--count];
      if (!reaches(nodes_[node], low, high)) continue;
      if (node < leaves_) {
        waiting[count++] = 2 * node + 1;
        waiting[count++] = 2 * node;
      } else if (!visit(static_cast<std::int32_t>(node - leaves_))) {
        return;
      }
    }
  }

  /// Calls `visit(number, squared distance)` for boxes nearer to `p` than a limit, approximately in
  /// the order of their distance; `visit` returns the new limit (squared steps). Precondition: `p`
  /// is finite.
  template <class Visit>
  void visit_near(const Eigen::Vector3d& p, double limit_squared, Visit visit) const {
    struct Waiting {
      std::size_t node;
      double squared;
    };
    std::array<Waiting, 64> waiting;
    std::size_t count = 0;
    waiting[count++] = {1, distance_squared(nodes_[1], p)};
    while (count > 0) {
      const Waiting next = waiting[--count];
      if (!(next.squared < limit_squared)) continue;
      if (next.node >= leaves_) {
        limit_squared = visit(static_cast<std::int32_t>(next.node - leaves_), next.squared);
        continue;
      }
      Waiting near{2 * next.node, distance_squared(nodes_[2 * next.node], p)};
      Waiting far{2 * next.node + 1, distance_squared(nodes_[2 * next.node + 1], p)};
      if (far.squared < near.squared) std::swap(near, far);
      waiting[count++] = far;
      waiting[count++] = near;
    }
  }

 private:
  std::size_t leaves_ = 1;      // a power of two; leaf k is node leaves_ + k
  std::vector<PageBox> nodes_;  // node n has the children 2 n and 2 n + 1; missing ones are empty
};

}  // namespace thimble::render
