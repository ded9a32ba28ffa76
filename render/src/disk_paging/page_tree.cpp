#include "disk_paging/page_tree.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace thimble::render {

PageTree::PageTree(std::span<const PageBox> boxes) : leaves_(std::bit_ceil(boxes.size())) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const PageBox empty{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  nodes_.assign(2 * leaves_, empty);
  std::copy(boxes.begin(), boxes.end(), nodes_.begin() + static_cast<std::ptrdiff_t>(leaves_));
  for (std::size_t node = leaves_ - 1; node >= 1; --node) {
    const PageBox& a = nodes_[2 * node];
    const PageBox& b = nodes_[2 * node + 1];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      nodes_[node].min[axis] = std::min(a.min[axis], b.min[axis]);
      nodes_[node].max[axis] = std::max(a.max[axis], b.max[axis]);
    }
  }
}

}  // namespace thimble::render
