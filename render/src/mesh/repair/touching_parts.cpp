#include "mesh/repair/touching_parts.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>
#include <vector>

#include "mesh/closest_point.h"
#include "mesh/mesh_edges.h"

namespace thimble::render {
namespace {

using Eigen::AlignedBox3d;
using Eigen::AlignedBox3f;
using Eigen::Vector3d;

// Maximum number of pairs of boxes examined, about a second's worth.
constexpr std::size_t kBoxPairsMax = 5'000'000;

// Maximum number of items in a leaf.
constexpr std::size_t kTouchLeaf = 4;

// The minimum share of a node's triangles on one side of the middle; else they are halved by
// number.
constexpr std::size_t kShareMin = 16;

// A triangle of a part whose box meets that of another part. The box is relative to the mesh's
// middle and larger than the triangle by more than the rounding.
struct PartTriangle {
  AlignedBox3f box;
  std::int32_t number = 0;
  std::int32_t part = 0;
};

// Returns whether the two triangles are separated by more than `tolerance` along some axis: an axis
// of the separating-axis theorem, or for flat pairs a normal of the edges in each plane.
bool are_apart(const std::array<Vector3d, 3>& a, const std::array<Vector3d, 3>& b,
               double tolerance) {
  const auto gap = [&](const Vector3d& axis) {
    const double length = axis.norm();
    if (!(length > 0)) return false;
    const Vector3d from_a(axis.dot(a[0]), axis.dot(a[1]), axis.dot(a[2]));
    const Vector3d from_b(axis.dot(b[0]), axis.dot(b[1]), axis.dot(b[2]));
    return std::max(from_a.minCoeff() - from_b.maxCoeff(), from_b.minCoeff() - from_a.maxCoeff()) >
           tolerance * length;
  };
  const std::array<Vector3d, 3> edges_a{a[1] - a[0], a[2] - a[1], a[0] - a[2]};
  const std::array<Vector3d, 3> edges_b{b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  const Vector3d normal_a = edges_a[0].cross(edges_a[1]);
  const Vector3d normal_b = edges_b[0].cross(edges_b[1]);
  if (gap(normal_a) || gap(normal_b)) return true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (gap(normal_a.cross(edges_a[i])) || gap(normal_b.cross(edges_b[i]))) return true;
    for (std::size_t k = 0; k < 3; ++k) {
      if (gap(edges_a[i].cross(edges_b[k]))) return true;
    }
  }
  return false;
}

// Returns a point that both triangles have, within about `tolerance`, by projecting a point onto
// the triangles in turn.
Vector3d common_point(const std::array<Vector3d, 3>& a, const std::array<Vector3d, 3>& b,
                      double tolerance) {
  constexpr int kRounds = 10'000;  // [chosen: below a millisecond; most pairs need fewer than ten]
  Vector3d p = (a[0] + a[1] + a[2] + b[0] + b[1] + b[2]) / 6;
  for (int round = 0; round < kRounds; ++round) {
    const Vector3d on_a = closest_point(p, a[0], a[1], a[2]);
    p = closest_point(on_a, b[0], b[1], b[2]);
    if ((p - on_a).norm() <= tolerance) break;
  }
  return p;
}

// A tree of boxes over triangles of parts, which is compared with itself. Nodes are split when they
// are visited: much of the mesh never is.
class TouchSearch {
 public:
  TouchSearch(const TriangleMesh& mesh, std::vector<PartTriangle> triangles, const Vector3d& middle,
              double tolerance)
      : mesh_(mesh), triangles_(std::move(triangles)), middle_(middle), tolerance_(tolerance) {
    add_node(0, triangles_.size());
  }

  TouchingParts run() {
    within(0);
    found_.pairs = pairs_.size();
    return found_;
  }

 private:
  struct Node {
    AlignedBox3f box;
    std::int32_t part_min = 0, part_max = 0;
    std::size_t begin = 0, end = 0;
    std::size_t left = 0, right = 0;  // 0: not split yet

    std::size_t size() const { return end - begin; }
    bool is_leaf() const { return size() <= kTouchLeaf; }
    bool is_one_part() const { return part_min == part_max; }
  };

  std::size_t add_node(std::size_t begin, std::size_t end);
  Node cut(std::size_t node);
  void within(std::size_t node);
  void between(std::size_t a, std::size_t b);
  void compare(const PartTriangle& a, const PartTriangle& b);
  bool known(std::int32_t a, std::int32_t b) const {
    return pairs_.contains(key(std::min(a, b), std::max(a, b)));
  }
  static std::uint64_t key(std::int32_t low, std::int32_t high) {
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
  }
  std::array<Vector3d, 3> corners(std::int32_t triangle) const {
    const auto& names = mesh_.triangles[static_cast<std::size_t>(triangle)];
    const auto at = [&](std::size_t k) -> Vector3d {
      return mesh_.vertices[static_cast<std::size_t>(names[k])] - middle_;
    };
    return {at(0), at(1), at(2)};
  }

  const TriangleMesh& mesh_;
  std::vector<PartTriangle> triangles_;
  const Vector3d middle_;  // far from the origin products would lose precision
  const double tolerance_;
  std::vector<Node> nodes_;
  std::unordered_set<std::uint64_t> pairs_;
  std::size_t looked_at_ = 0;
  TouchingParts found_;
};

std::size_t TouchSearch::add_node(std::size_t begin, std::size_t end) {
  Node node;
  node.begin = begin;
  node.end = end;
  node.part_min = node.part_max = triangles_[begin].part;
  for (std::size_t i = begin; i < end; ++i) {
    node.box.extend(triangles_[i].box);
    node.part_min = std::min(node.part_min, triangles_[i].part);
    node.part_max = std::max(node.part_max, triangles_[i].part);
  }
  nodes_.push_back(node);
  return nodes_.size() - 1;
}

// Returns a node with its halves.
TouchSearch::Node TouchSearch::cut(std::size_t number) {
  const Node node = nodes_[number];
  if (node.is_leaf() || node.left != 0) return node;
  Eigen::Index axis = 0;
  node.box.sizes().maxCoeff(&axis);
  const auto twice_center = [axis](const PartTriangle& triangle) {
    return triangle.box.min()[axis] + triangle.box.max()[axis];
  };
  const float twice_middle = node.box.min()[axis] + node.box.max()[axis];
  const auto begin = triangles_.begin() + static_cast<std::ptrdiff_t>(node.begin);
  const auto end = triangles_.begin() + static_cast<std::ptrdiff_t>(node.end);
  auto middle = std::partition(begin, end, [&](const PartTriangle& triangle) {
    return twice_center(triangle) < twice_middle;
  });
  const auto low = static_cast<std::size_t>(middle - begin);
  if (std::min(low, node.size() - low) < std::max<std::size_t>(1, node.size() / kShareMin)) {
    middle = begin + static_cast<std::ptrdiff_t>(node.size() / 2);
    std::nth_element(begin, middle, end, [&](const PartTriangle& a, const PartTriangle& b) {
      return twice_center(a) < twice_center(b);
    });
  }
  const auto cut_at = static_cast<std::size_t>(middle - triangles_.begin());
  const std::size_t left = add_node(node.begin, cut_at);
  const std::size_t right = add_node(cut_at, node.end);
  nodes_[number].left = left;
  nodes_[number].right = right;
  return nodes_[number];
}

void TouchSearch::within(std::size_t number) {
  if (nodes_[number].is_one_part()) return;
  const Node node = cut(number);
  if (!node.is_leaf()) {
    within(node.left);
    within(node.right);
    between(node.left, node.right);
    return;
  }
  for (std::size_t i = node.begin; i < node.end; ++i) {
    for (std::size_t k = node.begin; k < i; ++k) compare(triangles_[k], triangles_[i]);
  }
}

void TouchSearch::between(std::size_t a, std::size_t b) {
  const Node first = nodes_[a];
  const Node second = nodes_[b];
  if (first.is_one_part() && second.is_one_part() &&
      (first.part_min == second.part_min || known(first.part_min, second.part_min))) {
    return;
  }
  if (++looked_at_ > kBoxPairsMax) {
    found_.complete = false;
    return;
  }
  if (!first.box.intersects(second.box)) return;
  if (first.is_leaf() && second.is_leaf()) {
    for (std::size_t i = first.begin; i < first.end; ++i) {
      for (std::size_t k = second.begin; k < second.end; ++k) compare(triangles_[i], triangles_[k]);
    }
    return;
  }
  // Splits the larger one.
  if (!first.is_leaf() && (second.is_leaf() || first.size() > second.size())) {
    const Node halves = cut(a);
    between(halves.left, b);
    between(halves.right, b);
  } else {
    const Node halves = cut(b);
    between(a, halves.left);
    between(a, halves.right);
  }
}

void TouchSearch::compare(const PartTriangle& a, const PartTriangle& b) {
  if (a.part == b.part || !a.box.intersects(b.box) || known(a.part, b.part)) return;
  if (are_apart(corners(a.number), corners(b.number), tolerance_)) return;
  if (pairs_.empty()) {
    found_.triangles = {std::min(a.number, b.number), std::max(a.number, b.number)};
    found_.place = common_point(corners(a.number), corners(b.number), tolerance_) + middle_;
  }
  pairs_.insert(key(std::min(a.part, b.part), std::max(a.part, b.part)));
}

// Marks the parts whose boxes meet that of another part, from the left to the right.
std::vector<bool> find_near_parts(const std::vector<AlignedBox3d>& boxes) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!boxes[i].isEmpty()) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&boxes](std::size_t a, std::size_t b) {
    return boxes[a].min().x() < boxes[b].min().x();
  });
  std::vector<bool> near(boxes.size());
  std::vector<std::size_t> open;
  std::size_t compared = 0;
  for (const std::size_t part : order) {
    std::erase_if(
        open, [&](std::size_t other) { return boxes[other].max().x() < boxes[part].min().x(); });
    compared += open.size();
    if (compared > kBoxPairsMax) {  // many parts side by side: all are examined
      near.assign(boxes.size(), true);
      return near;
    }
    for (const std::size_t other : open) {
      if (!boxes[other].intersects(boxes[part])) continue;
      near[other] = true;
      near[part] = true;
    }
    open.push_back(part);
  }
  return near;
}

}  // namespace

TouchingParts find_touching_parts(const TriangleMesh& mesh) {
  // Parts are numbered by their smallest vertex.
  Groups groups(mesh.vertices.size());
  AlignedBox3d whole;
  const auto is_whole = [&mesh](std::size_t t) {
    if (!has_three_vertices(mesh, t)) return false;
    const auto& names = mesh.triangles[t];
    return std::all_of(names.begin(), names.end(), [&mesh](std::int32_t v) {
      return mesh.vertices[static_cast<std::size_t>(v)].allFinite();
    });
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!is_whole(t)) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    groups.join(a, b);
    groups.join(b, c);
  }
  std::vector<std::int32_t> part_of(mesh.vertices.size());
  std::size_t parts = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto root = static_cast<std::size_t>(groups.find(static_cast<std::int32_t>(v)));
    part_of[v] = root == v ? static_cast<std::int32_t>(parts++) : part_of[root];
    if (mesh.vertices[v].allFinite()) whole.extend(mesh.vertices[v]);
  }
  if (parts < 2 || whole.isEmpty()) return {};
  const double size = whole.diagonal().norm();
  constexpr double kSizeMax = 1e30;  // its boxes are in single precision
  if (!(size < kSizeMax)) return {};
  const double tolerance = kFlushTolerance * size;
  const Vector3d margin = Vector3d::Constant(2 * tolerance);
  std::vector<AlignedBox3d> boxes(parts);
  const auto box_of = [&](std::size_t t) {
    AlignedBox3d box;
    for (const std::int32_t v : mesh.triangles[t]) {
      box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
    }
    return AlignedBox3d(box.min() - margin, box.max() + margin);
  };
  const auto part_of_triangle = [&](std::size_t t) {
    return part_of[static_cast<std::size_t>(mesh.triangles[t][0])];
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_whole(t)) boxes[static_cast<std::size_t>(part_of_triangle(t))].extend(box_of(t));
  }
  const std::vector<bool> near = find_near_parts(boxes);
  const Vector3d middle = whole.center();
  std::vector<PartTriangle> triangles;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!is_whole(t)) continue;
    const std::int32_t part = part_of_triangle(t);
    if (near[static_cast<std::size_t>(part)]) {
      const AlignedBox3d box = box_of(t);
      triangles.push_back(
          {AlignedBox3f((box.min() - middle).cast<float>(), (box.max() - middle).cast<float>()),
           static_cast<std::int32_t>(t), part});
    }
  }
  if (triangles.empty()) return {};
  return TouchSearch(mesh, std::move(triangles), middle, tolerance).run();
}

std::string describe(const TouchingParts& parts) {
  if (parts.pairs == 0) return {};
  const std::string pairs = fmt::format("{}{} pair{} of parts", parts.complete ? "" : "At least ",
                                        parts.pairs, parts.pairs == 1 ? "" : "s");
  return fmt::format(
      "{} overlap or lie flush against each other (first: triangles {} and {}, at ({:.4g}, "
      "{:.4g}, {:.4g})). The tip feels their union. Join them into one body in a mesh editor if "
      "the object dents or changes shape.",
      pairs, parts.triangles[0], parts.triangles[1], parts.place.x(), parts.place.y(),
      parts.place.z());
}

}  // namespace thimble::render
