#include "ball/triangle_tree.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "mesh/triangle_closest_point.h"
#include "world/box_tree.h"

namespace thimble::render {

using Eigen::Vector3d;

namespace {

// Triangles of a leaf. [chosen: fastest of 2, 4 and 8]
constexpr std::size_t kLeafMax = 4;

double squared_distance_to(const ContactMesh& mesh, std::int32_t triangle,
                           const Vector3d& p) noexcept {
  return closest_on(mesh, triangle, p).distance_squared;
}

}  // namespace

TriangleTree::TriangleTree(std::shared_ptr<const ContactMesh> mesh) : mesh_(std::move(mesh)) {
  triangles_.resize(static_cast<std::size_t>(mesh_->triangle_count()));
  std::iota(triangles_.begin(), triangles_.end(), 0);
  if (triangles_.empty()) return;
  nodes_.reserve(triangles_.size());
  build(triangles_, 0);
  nodes_.shrink_to_fit();
}

// Halves the triangles by the middles of their boxes along the longest side.
std::int32_t TriangleTree::build(std::span<std::int32_t> triangles, std::int32_t first) {
  const auto number = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  const auto box_of = [this](std::int32_t t) {
    const Vector3d &a = mesh_->position(t, 0), &b = mesh_->position(t, 1),
                   &c = mesh_->position(t, 2);
    return SolidBox{a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
  };
  Node node{.box = box_of(triangles[0]), .first = first};
  for (const std::int32_t t : triangles) {
    const SolidBox one = box_of(t);
    node.box.min = node.box.min.cwiseMin(one.min);
    node.box.max = node.box.max.cwiseMax(one.max);
  }
  if (triangles.size() <= kLeafMax) {
    node.count = static_cast<std::int32_t>(triangles.size());
  } else {
    Eigen::Index axis = 0;
    (node.box.max - node.box.min).maxCoeff(&axis);
    const std::size_t half = triangles.size() / 2;
    const auto middle = [&](std::int32_t t) {
      const SolidBox box = box_of(t);
      return box.min[axis] + box.max[axis];
    };
    std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half),
                     triangles.end(), [&](std::int32_t a, std::int32_t b) {
                       const double x = middle(a), y = middle(b);
                       return x < y || (x == y && a < b);
                     });
    build(triangles.first(half), first);
    node.right = build(triangles.subspan(half), first + static_cast<std::int32_t>(half));
  }
  nodes_[static_cast<std::size_t>(number)] = node;
  return number;
}

template <class Bound, class Visit>
void TriangleTree::descend(const Vector3d& p, const Bound& bound,
                           const Visit& visit) const noexcept {
  std::array<std::int32_t, kWaitingMax> waiting;
  std::size_t size = 0;
  if (!nodes_.empty()) waiting[size++] = 0;
  while (size > 0) {
    const std::int32_t number = waiting[--size];
    const Node& node = nodes_[static_cast<std::size_t>(number)];
    // Written so that NaN finds nothing.
    if (!(squared_distance(node.box, p) <= bound())) continue;
    for (std::int32_t i = 0; i < node.count; ++i) {
      visit(triangles_[static_cast<std::size_t>(node.first + i)]);
    }
    if (node.count > 0) continue;
    const Node& left = nodes_[static_cast<std::size_t>(number + 1)];
    const Node& right = nodes_[static_cast<std::size_t>(node.right)];
    const bool left_first = squared_distance(left.box, p) <= squared_distance(right.box, p);
    waiting[size++] = left_first ? node.right : number + 1;
    waiting[size++] = left_first ? number + 1 : node.right;
  }
}

double TriangleTree::near(const Vector3d& p, double radius, std::span<NearTriangle> found,
                          std::size_t& count) const noexcept {
  count = 0;
  double squared = radius * radius;
  // A heap with the farthest triangle on top while it is full.
  const auto nearer = [](const NearTriangle& a, const NearTriangle& b) {
    return a.distance < b.distance || (a.distance == b.distance && a.triangle < b.triangle);
  };
  descend(
      p, [&] { return squared; },
      [&](std::int32_t triangle) {
        const NearTriangle one{triangle, squared_distance_to(*mesh_, triangle, p)};
        if (!(one.distance <= squared)) return;
        if (count < found.size()) {
          found[count++] = one;
          if (count < found.size()) return;
          std::make_heap(found.begin(), found.end(), nearer);
        } else {
          if (!nearer(one, found.front())) return;
          std::pop_heap(found.begin(), found.end(), nearer);
          found.back() = one;
          std::push_heap(found.begin(), found.end(), nearer);
        }
        squared = found.front().distance;
      });
  const auto list = found.first(count);
  std::sort(list.begin(), list.end(), nearer);
  for (NearTriangle& one : list) one.distance = std::sqrt(one.distance);
  if (count < found.size()) return radius;
  // Since the list was full, farther triangles were not visited. Without those at the same distance
  // that others may have displaced.
  return list.back().distance * (1 - 0x1p-50);
}

double TriangleTree::distance(const Vector3d& p, double bound) const noexcept {
  double nearest = bound * bound;
  descend(
      p, [&] { return nearest; },
      [&](std::int32_t triangle) {
        nearest = std::min(nearest, squared_distance_to(*mesh_, triangle, p));
      });
  return std::sqrt(nearest);
}

}  // namespace thimble::render
