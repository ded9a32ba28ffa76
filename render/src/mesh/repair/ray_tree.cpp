#include "mesh/repair/ray_tree.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace thimble::render {

RayTree::RayTree(std::vector<Item> items) : items_(std::move(items)) {
  if (items_.empty()) return;
  // Halving rounds up at most once per level: one level more than the exact number of halvings.
  nodes_.resize(4 * std::bit_ceil((items_.size() + kLeaf - 1) / kLeaf));
  build(0, 0, items_.size());
}

void RayTree::build(std::size_t node, std::size_t begin, std::size_t end) {
  Node& here = nodes_[node];
  here.x_max = -std::numeric_limits<double>::infinity();
  for (std::size_t i = begin; i < end; ++i) {
    here.x_max = std::max(here.x_max, items_[i].x_max);
    here.yz.extend(items_[i].yz);
  }
  if (end - begin <= kLeaf) return;
  const Eigen::Vector2d size = here.yz.sizes();
  const Eigen::Index axis = size.x() > size.y() ? 0 : 1;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [axis](const Item& a, const Item& b) {
    return a.yz.center()[axis] < b.yz.center()[axis];
  });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

}  // namespace thimble::render
