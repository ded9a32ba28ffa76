#include "world/box_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace thimble::render {

using Eigen::Vector3d;

BoxTree::BoxTree(std::vector<SolidBox> boxes, std::vector<std::int32_t> solids)
    : boxes_(std::move(boxes)) {
  if (solids.empty()) return;
  nodes_.reserve(2 * solids.size());
  build(solids);
}

// Halves the boxes by their middles along the longest side.
std::int32_t BoxTree::build(std::span<std::int32_t> solids) {
  const auto number = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  SolidBox all = box(solids[0]);
  for (const std::int32_t solid : solids) {
    all.min = all.min.cwiseMin(box(solid).min);
    all.max = all.max.cwiseMax(box(solid).max);
  }
  Node node{.box = all};
  if (solids.size() == 1) {
    node.solid = solids[0];
  } else {
    Eigen::Index axis = 0;
    (all.max - all.min).maxCoeff(&axis);
    const std::size_t half = solids.size() / 2;
    const auto middle = [&](std::int32_t solid) {
      return box(solid).min[axis] + box(solid).max[axis];
    };
    std::nth_element(solids.begin(), solids.begin() + static_cast<std::ptrdiff_t>(half),
                     solids.end(), [&](std::int32_t a, std::int32_t b) {
                       return middle(a) < middle(b) || (middle(a) == middle(b) && a < b);
                     });
    node.left = build(solids.first(half));
    node.right = build(solids.subspan(half));
  }
  nodes_[static_cast<std::size_t>(number)] = node;
  return number;
}

bool BoxTree::near(const Vector3d& p, double radius, std::size_t count_max,
                   std::vector<std::int32_t>& found) const noexcept {
  found.clear();
  if (nodes_.empty()) return true;
  const double squared = radius * radius;
  const std::size_t room = std::min(count_max, found.capacity());
  std::array<std::int32_t, kWaitingMax> waiting;
  std::size_t size = 0;
  waiting[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(waiting[--size])];
    // Written so that NaN finds nothing.
    if (!(squared_distance(node.box, p) <= squared)) continue;
    if (node.solid < 0) {
      waiting[size++] = node.right;
      waiting[size++] = node.left;
      continue;
    }
    if (found.size() == room) return false;
    found.push_back(node.solid);
  }
  std::sort(found.begin(), found.end());
  return true;
}

double BoxTree::distance(const Vector3d& p) const noexcept {
  double nearest = std::numeric_limits<double>::infinity();
  if (nodes_.empty()) return nearest;
  std::array<std::int32_t, kWaitingMax> waiting;
  std::size_t size = 0;
  waiting[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(waiting[--size])];
    const double here = squared_distance(node.box, p);
    if (!(here < nearest)) continue;
    if (node.solid >= 0) {
      nearest = here;
      continue;
    }
    const Node& left = nodes_[static_cast<std::size_t>(node.left)];
    const Node& right = nodes_[static_cast<std::size_t>(node.right)];
    // The nearer one first.
    const bool left_first = squared_distance(left.box, p) <= squared_distance(right.box, p);
    waiting[size++] = left_first ? node.right : node.left;
    waiting[size++] = left_first ? node.left : node.right;
  }
  return std::sqrt(nearest);
}

}  // namespace thimble::render
