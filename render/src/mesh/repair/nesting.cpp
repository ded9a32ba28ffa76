#include "mesh/repair/nesting.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "mesh/repair/ray_tree.h"
#include "mesh/segment_crossing.h"

namespace thimble::render {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// Enough to distinguish components which overlap by half from nested ones, few enough that a file
// of many small parts is checked in seconds.
constexpr std::size_t kWitnesses = 8;

const Vector3d& corner(const TriangleMesh& mesh, std::int32_t triangle, std::size_t k) {
  const auto& triangle_corners = mesh.triangles[static_cast<std::size_t>(triangle)];
  return mesh.vertices[static_cast<std::size_t>(triangle_corners[k])];
}

// The triangles of closed components, grouped by component, in the order of their numbers.
class Parts {
 public:
  Parts(const TriangleMesh& mesh, const MeshComponents& found)
      : mesh_(mesh), begin_(found.count + 1, 0), boxes_(found.count) {
    const auto is_closed = [&found](std::int32_t part) {
      return found.closed[static_cast<std::size_t>(part)];
    };
    for (const std::int32_t part : found.component_of) {
      if (is_closed(part)) ++begin_[static_cast<std::size_t>(part) + 1];
    }
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    triangles_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t t = 0; t < found.component_of.size(); ++t) {
      const std::int32_t part = found.component_of[t];
      if (!is_closed(part)) continue;
      triangles_[next[static_cast<std::size_t>(part)]++] = static_cast<std::int32_t>(t);
      for (std::size_t k = 0; k < 3; ++k) {
        boxes_[static_cast<std::size_t>(part)].extend(
            corner(mesh, static_cast<std::int32_t>(t), k));
      }
    }
  }

  std::size_t count() const { return boxes_.size(); }
  const AlignedBox3d& box(std::size_t part) const { return boxes_[part]; }
  std::span<const std::int32_t> triangles(std::size_t part) const {
    return {triangles_.data() + begin_[part], begin_[part + 1] - begin_[part]};
  }

  // Six times the volume, about the part's own middle: far from the origin it would be lost in
  // rounding.
  double volume(std::size_t part) const {
    double volume = 0;
    const Vector3d middle = boxes_[part].center();
    for (const std::int32_t t : triangles(part)) {
      volume += (corner(mesh_, t, 0) - middle)
                    .dot((corner(mesh_, t, 1) - middle).cross(corner(mesh_, t, 2) - middle));
    }
    return volume;
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<std::size_t> begin_;
  std::vector<std::int32_t> triangles_;
  std::vector<AlignedBox3d> boxes_;
};

RayTree tree_of(const TriangleMesh& mesh, std::span<const std::int32_t> triangles) {
  std::vector<RayTree::Item> items;
  items.reserve(triangles.size());
  for (const std::int32_t t : triangles) {
    AlignedBox3d box;
    for (std::size_t k = 0; k < 3; ++k) box.extend(corner(mesh, t, k));
    items.push_back(RayTree::item(t, box));
  }
  return RayTree(std::move(items));
}

// Finds the parts around each part, from the largest to the smallest.
class Nesting {
 public:
  Nesting(const TriangleMesh& mesh, const Parts& parts)
      : mesh_(mesh),
        parts_(parts),
        nests_(parts.count()),
        trees_(parts.count()),
        asked_(parts.count(), -1) {}

  void run(std::vector<ClosedPart>& closed) {
    std::vector<std::int32_t> order;
    std::vector<RayTree::Item> items;
    for (std::size_t i = 0; i < parts_.count(); ++i) {
      if (parts_.triangles(i).empty()) continue;
      order.push_back(static_cast<std::int32_t>(i));
      items.push_back(RayTree::item(order.back(), parts_.box(i)));
    }
    if (order.size() < 2) return;
    const auto size_of = [this](std::int32_t part) {
      return parts_.box(static_cast<std::size_t>(part)).diagonal().norm();
    };
    std::stable_sort(order.begin(), order.end(), [&size_of](std::int32_t a, std::int32_t b) {
      return size_of(a) > size_of(b);
    });
    const RayTree boxes(std::move(items));
    std::vector<std::int32_t> outer;
    for (const std::int32_t part : order) {
      const auto i = static_cast<std::size_t>(part);
      outer.clear();
      boxes.visit(parts_.box(i).min(), [&](std::int32_t other) {
        if (other != part && parts_.box(static_cast<std::size_t>(other)).contains(parts_.box(i))) {
          outer.push_back(other);
        }
      });
      std::sort(outer.begin(), outer.end(), [&size_of](std::int32_t a, std::int32_t b) {
        return std::pair(size_of(a), a) < std::pair(size_of(b), b);
      });
      closed[i].nested_in = nest(part, outer);
    }
  }

 private:
  // The parts around a part: the smallest, `parent`, all around that one, and others.
  struct Nest {
    std::int32_t parent = -1;
    std::vector<std::int32_t> others;
  };

  // `outer`: those whose boxes contain the part's box, the smallest first. A part inside its parent
  // is inside all parts around the parent; only others need rays.
  std::size_t nest(std::int32_t part, const std::vector<std::int32_t>& outer) {
    const auto i = static_cast<std::size_t>(part);
    std::size_t count = 0;
    for (const std::int32_t other : outer) {
      if (asked_[static_cast<std::size_t>(other)] == part) {
        ++count;
        continue;
      }
      if (!lies_in(i, static_cast<std::size_t>(other))) continue;
      ++count;
      if (nests_[i].parent < 0) {
        nests_[i].parent = other;
        mark(other, part);
      } else {
        nests_[i].others.push_back(other);
      }
    }
    return count;
  }

  // Marks for `part` all parts around `parent`.
  void mark(std::int32_t parent, std::int32_t part) {
    // Parts that are copies of each other may be inside each other.
    for (std::int32_t at = parent; at >= 0 && asked_[static_cast<std::size_t>(at)] != part;
         at = nests_[static_cast<std::size_t>(at)].parent) {
      asked_[static_cast<std::size_t>(at)] = part;
      for (const std::int32_t other : nests_[static_cast<std::size_t>(at)].others) {
        asked_[static_cast<std::size_t>(other)] = part;
      }
    }
  }

  // Returns whether a part is inside another one, by up to eight of its vertices.
  bool lies_in(std::size_t inner, std::size_t outer) {
    if (!trees_[outer]) trees_[outer].emplace(tree_of(mesh_, parts_.triangles(outer)));
    const std::span<const std::int32_t> triangles = parts_.triangles(inner);
    const AlignedBox3d& box = parts_.box(outer);
    const std::size_t step = std::max<std::size_t>(1, triangles.size() / kWitnesses);
    for (std::size_t i = 0; i < triangles.size(); i += step) {
      const Vector3d& witness = corner(mesh_, triangles[i], 0);
      Vector3d far = witness;
      far.x() = box.max().x() + box.diagonal().norm();
      std::size_t crossings = 0;
      trees_[outer]->visit(witness, [&](std::int32_t t) {
        crossings += crossing(witness, far, corner(mesh_, t, 0), corner(mesh_, t, 1),
                              corner(mesh_, t, 2)) != Crossing::kNone;
      });
      if (crossings % 2 == 0) return false;
    }
    return true;
  }

  const TriangleMesh& mesh_;
  const Parts& parts_;
  std::vector<Nest> nests_;
  std::vector<std::optional<RayTree>> trees_;
  std::vector<std::int32_t> asked_;  // the part for which each was marked last
};

}  // namespace

std::vector<ClosedPart> nest_components(const TriangleMesh& mesh, const MeshComponents& found) {
  const Parts parts(mesh, found);
  std::vector<ClosedPart> closed(found.count);
  for (std::size_t i = 0; i < found.count; ++i) closed[i].volume = parts.volume(i);
  Nesting(mesh, parts).run(closed);
  return closed;
}

}  // namespace thimble::render
