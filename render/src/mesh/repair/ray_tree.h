#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace thimble::render {

/// A tree of boxes for rays along +x: finds boxes that contain a point's y and z and do not end
/// before its x. Real-time: never from the servo thread.
class RayTree {
 public:
  /// A numbered box, projected for a ray along x.
  struct Item {
    std::int32_t number = 0;
    double x_max = 0;
    Eigen::AlignedBox2d yz;
  };

  /// Returns the item of a box.
  static Item item(std::int32_t number, const Eigen::AlignedBox3d& box) {
    return {number, box.max().x(), Eigen::AlignedBox2d(box.min().tail<2>(), box.max().tail<2>())};
  }

  /// Takes the items and sorts them into a tree: O(n log n) for any distribution.
  explicit RayTree(std::vector<Item> items);

  /// Calls `take(number)` for every item that the ray from `p` along +x may meet, ends included.
  template <class Take>
  void visit(const Eigen::Vector3d& p, Take&& take) const {
    if (!nodes_.empty()) visit_node(0, 0, items_.size(), p, take);
  }

 private:
  // Maximum number of items in a leaf.
  static constexpr std::size_t kLeaf = 8;

  struct Node {
    double x_max = 0;
    Eigen::AlignedBox2d yz;
  };

  static bool meets(double x_max, const Eigen::AlignedBox2d& yz, const Eigen::Vector3d& p) {
    return x_max >= p.x() && yz.contains(p.tail<2>());
  }

  // Nodes are stored as in a heap: the halves of node i are 2 i + 1 and 2 i + 2.
  void build(std::size_t node, std::size_t begin, std::size_t end);

  template <class Take>
  void visit_node(std::size_t node, std::size_t begin, std::size_t end, const Eigen::Vector3d& p,
                  Take& take) const {
    if (!meets(nodes_[node].x_max, nodes_[node].yz, p)) return;
    if (end - begin <= kLeaf) {
      for (std::size_t i = begin; i < end; ++i) {
        if (meets(items_[i].x_max, items_[i].yz, p)) take(items_[i].number);
      }
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    visit_node(2 * node + 1, begin, middle, p, take);
    visit_node(2 * node + 2, middle, end, p, take);
  }

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

}  // namespace thimble::render
