#include "hand/sphere_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace thimble::scene {
namespace {

using Eigen::Vector3d;

// The distance from a box is reduced by this fraction, so that rounding cannot exclude a sphere.
constexpr double kRounding = 1e-12;

}  // namespace

SphereTree::SphereTree(std::vector<Sphere> spheres) : spheres_(std::move(spheres)) {
  for (std::size_t i = 0; i < spheres_.size(); ++i) spheres_[i].number = i;
  if (spheres_.empty()) return;
  // Each division by two rounds up at most once, so there is one level more than whole divisions.
  nodes_.resize(4 * std::bit_ceil((spheres_.size() + kLeaf - 1) / kLeaf));
  build(0, 0, spheres_.size());
}

void SphereTree::build(std::size_t node, std::size_t begin, std::size_t end) {
  Node& here = nodes_[node];
  for (std::size_t i = begin; i < end; ++i) {
    here.centers.extend(spheres_[i].center);
    here.radius_max = std::max(here.radius_max, spheres_[i].radius);
  }
  if (end - begin <= kLeaf) return;
  Eigen::Index axis = 0;
  here.centers.sizes().maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) {
    return spheres_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(at(begin), at(middle), at(end), [axis](const Sphere& a, const Sphere& b) {
    return a.center[axis] < b.center[axis];
  });
  build(2 * node + 1, begin, middle);
  build(2 * node + 2, middle, end);
}

// Returns a lower bound of the distance from a point to the centres of the spheres of a node.
double SphereTree::distance(std::size_t node, const Vector3d& p) const {
  return (1 - kRounding) * std::sqrt(nodes_[node].centers.squaredExteriorDistance(p));
}

double SphereTree::nearest_far_side(const Vector3d& p) const {
  double nearest = std::numeric_limits<double>::infinity();
  if (!nodes_.empty()) search_far_side(0, 0, spheres_.size(), p, nearest);
  return nearest;
}

void SphereTree::search_far_side(std::size_t node, std::size_t begin, std::size_t end,
                                 const Vector3d& p, double& nearest) const {
  if (distance(node, p) > nearest) return;
  if (end - begin <= kLeaf) {
    for (std::size_t i = begin; i < end; ++i) {
      nearest = std::min(nearest, spheres_[i].distance(p) + spheres_[i].radius);
    }
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  const bool left_first = distance(2 * node + 1, p) <= distance(2 * node + 2, p);
  if (left_first) search_far_side(2 * node + 1, begin, middle, p, nearest);
  search_far_side(2 * node + 2, middle, end, p, nearest);
  if (!left_first) search_far_side(2 * node + 1, begin, middle, p, nearest);
}

void SphereTree::find_within(const Vector3d& p, double reach,
                             std::vector<std::size_t>& found) const {
  found.clear();
  if (!nodes_.empty()) search_within(0, 0, spheres_.size(), p, reach, found);
  std::sort(found.begin(), found.end());
}

void SphereTree::search_within(std::size_t node, std::size_t begin, std::size_t end,
                               const Vector3d& p, double reach,
                               std::vector<std::size_t>& found) const {
  if (distance(node, p) - nodes_[node].radius_max > reach) return;
  if (end - begin <= kLeaf) {
    for (std::size_t i = begin; i < end; ++i) {
      if (spheres_[i].distance(p) - spheres_[i].radius <= reach) {
        found.push_back(spheres_[i].number);
      }
    }
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  search_within(2 * node + 1, begin, middle, p, reach, found);
  search_within(2 * node + 2, middle, end, p, reach, found);
}

}  // namespace thimble::scene
