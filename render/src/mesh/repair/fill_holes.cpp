#include "mesh/repair/fill_holes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "mesh/mesh_edges.h"
#include "mesh/repair/fill_polygon.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Places of a rim closer than this share of the mesh's size are the same: copies of a vertex made
// by split_fans.
constexpr double kSamePlace = 1e-12;

// A ring of open edges, and its filling.
struct Ring {
  std::vector<EdgeUse> sides;          // in the order of the ring
  std::vector<std::int32_t> vertices;  // begin of each side
  std::vector<std::array<std::int32_t, 3>> triangles;
  bool closes_at_middle = false;  // a vertex of its own, the number after the mesh's last
  Vector3d middle{0, 0, 0};
  double area = 0, width = 0;
};

std::uint64_t key_of(std::int32_t a, std::int32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 |
         static_cast<std::uint64_t>(std::max(a, b));
}

class Filling {
 public:
  Filling(TriangleMesh& mesh, double share, std::vector<std::int32_t>& origin)
      : mesh_(mesh),
        share_(share),
        origin_(origin),
        old_triangles_(mesh.triangles.size()),
        parts_(mesh.triangles.size()) {
    for (const Vector3d& p : mesh.vertices) {
      if (p.allFinite()) size_ = std::max(size_, p.cwiseAbs().maxCoeff());
    }
  }

  std::vector<FilledHole> run() {
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh_);
    look_at_edges(uses);
    if (open_.empty()) return {};
    note_taken_edges(uses);
    find_areas();
    find_rings();
    std::unordered_set<std::int32_t> closed;
    for (auto& [part, rings] : rings_of_) {
      if (spoilt_.contains(part) || !can_close(part, rings)) continue;
      close(rings);
      closed.insert(part);
    }
    join_copies(closed);
    return std::move(filled_);
  }

 private:
  const Vector3d& at(std::int32_t v) const { return mesh_.vertices[static_cast<std::size_t>(v)]; }

  Vector3d area_of(std::int32_t a, std::int32_t b, std::int32_t c) const {
    return (at(b) - at(a)).cross(at(c) - at(a)) / 2;
  }

  void look_at_edges(const std::vector<EdgeUse>& uses) {
    std::vector<std::int32_t> crowded;
    for (std::size_t begin = 0; begin < uses.size();) {
      const std::size_t end = end_of_edge(uses, begin);
      for (std::size_t i = begin + 1; i < end; ++i) {
        parts_.join(uses[begin].triangle, uses[i].triangle);
      }
      if (end - begin == 1) open_.push_back(uses[begin]);
      if (end - begin > 2) crowded.push_back(uses[begin].triangle);
      begin = end;
    }
    for (const std::int32_t t : crowded) spoilt_.insert(parts_.find(t));
  }

  void note_taken_edges(const std::vector<EdgeUse>& uses) {
    std::vector<bool> on_rim(mesh_.vertices.size(), false);
    for (const EdgeUse& use : open_) {
      on_rim[static_cast<std::size_t>(use.low)] = on_rim[static_cast<std::size_t>(use.high)] = true;
    }
    for (const EdgeUse& use : uses) {
      if (on_rim[static_cast<std::size_t>(use.low)] && on_rim[static_cast<std::size_t>(use.high)]) {
        taken_.insert(key_of(use.low, use.high));
      }
    }
  }

  // Merges vertices where rings came twice, in the triangles of parts that were closed.
  void join_copies(const std::unordered_set<std::int32_t>& closed) {
    if (same_.empty()) return;
    for (std::size_t t = 0; t < old_triangles_; ++t) {
      if (!closed.contains(parts_.find(static_cast<std::int32_t>(t)))) continue;
      for (std::int32_t& v : mesh_.triangles[t]) v = same_of(v);
    }
  }

  void find_areas() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      area_of_[parts_.find(static_cast<std::int32_t>(t))] += area_of(a, b, c).norm();
    }
  }

  // Joins open edges to rings: each vertex of a rim has two of them. A ring that comes to one place
  // twice is two rings there, and its copies of the vertex are one.
  void find_rings() {
    std::unordered_map<std::int32_t, std::array<std::int32_t, 2>> open_at;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      for (const std::int32_t v : {open_[i].low, open_[i].high}) {
        auto& two = open_at.try_emplace(v, std::array<std::int32_t, 2>{-1, -1}).first->second;
        if (two[1] >= 0) spoilt_.insert(parts_.find(open_[i].triangle));
        (two[0] < 0 ? two[0] : two[1]) = static_cast<std::int32_t>(i);
      }
    }
    std::vector<bool> seen(open_.size(), false);
    for (std::size_t first = 0; first < open_.size(); ++first) {
      const std::int32_t part = parts_.find(open_[first].triangle);
      if (seen[first] || spoilt_.contains(part)) continue;
      Ring ring;
      // The hole has an edge in the opposite direction of the adjacent triangle.
      std::int32_t vertex = open_[first].upward ? open_[first].high : open_[first].low;
      std::size_t i = first;
      while (!seen[i]) {
        seen[i] = true;
        ring.sides.push_back(open_[i]);
        ring.vertices.push_back(vertex);
        vertex = open_[i].low == vertex ? open_[i].high : open_[i].low;
        const auto& two = open_at.at(vertex);
        if (two[1] < 0) break;  // two parts share one vertex number: not a ring
        i = static_cast<std::size_t>(static_cast<std::size_t>(two[0]) == i ? two[1] : two[0]);
      }
      if (i != first || ring.sides.size() < 3 || ring.sides.size() > kHoleEdgesMax) {
        spoilt_.insert(part);
      } else {
        cut_ring(ring, rings_of_[part]);
      }
    }
  }

  // Cuts a ring where it comes to one place twice. A rest of two sides closes by itself.
  void cut_ring(const Ring& whole, std::vector<Ring>& rings) {
    Ring rest;
    const auto take = [&rings, &rest](std::size_t from) {
      const auto begin = static_cast<std::ptrdiff_t>(from);
      Ring ring;
      ring.sides.assign(rest.sides.begin() + begin, rest.sides.end());
      ring.vertices.assign(rest.vertices.begin() + begin, rest.vertices.end());
      rest.sides.resize(from);
      rest.vertices.resize(from);
      if (ring.sides.size() > 2) rings.push_back(std::move(ring));
    };
    for (std::size_t i = 0; i < whole.sides.size(); ++i) {
      const std::int32_t vertex = whole.vertices[i];
      for (std::size_t k = 0; k < rest.vertices.size(); ++k) {
        if (!same_place(rest.vertices[k], vertex)) continue;
        same_.emplace(vertex, rest.vertices[k]);
        take(k);
        break;
      }
      rest.sides.push_back(whole.sides[i]);
      rest.vertices.push_back(same_of(vertex));
    }
    take(0);
  }

  bool same_place(std::int32_t a, std::int32_t b) const {
    return (at(a) - at(b)).norm() <= kSamePlace * size_;
  }

  std::int32_t same_of(std::int32_t vertex) const {
    const auto found = same_.find(vertex);
    return found == same_.end() ? vertex : found->second;
  }

  void measure(Ring& ring) const {
    Eigen::AlignedBox3d box;
    for (const std::int32_t v : ring.vertices) {
      box.extend(at(v));
      ring.middle += at(v) / static_cast<double>(ring.vertices.size());
    }
    ring.width = box.diagonal().norm();
  }

  void find_triangles(Ring& ring) const {
    HoleRing hole;
    for (std::size_t i = 0; i < ring.sides.size(); ++i) {
      hole.corners.push_back(at(ring.vertices[i]));
      const auto& [a, b, c] = mesh_.triangles[static_cast<std::size_t>(ring.sides[i].triangle)];
      const EdgeUse& side = ring.sides[i];
      const bool against = same_of(side.upward ? side.high : side.low) == ring.vertices[i];
      hole.beside.push_back((against ? 1.0 : -1.0) * area_of(a, b, c).normalized());
    }
    const auto taken = [&](std::int32_t i, std::int32_t j) {
      return taken_.contains(key_of(ring.vertices[static_cast<std::size_t>(i)],
                                    ring.vertices[static_cast<std::size_t>(j)]));
    };
    for (const auto& corners : fill_polygon(hole, taken)) {
      std::array<std::int32_t, 3> triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] = ring.vertices[static_cast<std::size_t>(corners[k])];
      }
      ring.triangles.push_back(triangle);
      ring.area += area_of(triangle[0], triangle[1], triangle[2]).norm();
    }
    if (!ring.triangles.empty()) return;
    // Nothing is joined to a new vertex yet.
    ring.closes_at_middle = true;
    for (std::size_t i = 0; i < ring.vertices.size(); ++i) {
      const Vector3d& next = at(ring.vertices[(i + 1) % ring.vertices.size()]);
      const Vector3d side = next - at(ring.vertices[i]), in = ring.middle - at(ring.vertices[i]);
      const double twice_area = side.cross(in).norm();
      const double longest =
          std::max({side.squaredNorm(), in.squaredNorm(), (in - side).squaredNorm()});
      // A slit of no width cannot be filled.
      if (!(twice_area > kFillFlatness * longest))
        ring.area = std::numeric_limits<double>::infinity();
      ring.area += twice_area / 2;
    }
  }

  bool can_close(std::int32_t part, std::vector<Ring>& rings) const {
    const double most = share_ * area_of_.at(part);
    double area = 0;
    for (Ring& ring : rings) {
      measure(ring);
      find_triangles(ring);
      area += ring.area;
      if (!(area <= most)) return false;
    }
    return true;
  }

  void close(const std::vector<Ring>& rings) {
    for (const Ring& ring : rings) {
      const std::int32_t source = origin_[static_cast<std::size_t>(ring.sides.front().triangle)];
      const auto add = [&](const std::array<std::int32_t, 3>& triangle) {
        mesh_.triangles.push_back(triangle);
        origin_.push_back(source);
        for (std::size_t k = 0; k < 3; ++k)
          taken_.insert(key_of(triangle[k], triangle[(k + 1) % 3]));
      };
      for (const auto& triangle : ring.triangles) add(triangle);
      if (ring.closes_at_middle) {
        const auto middle = static_cast<std::int32_t>(mesh_.vertices.size());
        mesh_.vertices.push_back(ring.middle);
        for (std::size_t i = 0; i < ring.vertices.size(); ++i) {
          add({ring.vertices[i], ring.vertices[(i + 1) % ring.vertices.size()], middle});
        }
      }
      filled_.push_back({ring.sides.size(), ring.width, ring.middle});
    }
  }

  TriangleMesh& mesh_;
  const double share_;
  std::vector<std::int32_t>& origin_;
  const std::size_t old_triangles_;
  Groups parts_;
  std::vector<EdgeUse> open_;
  std::unordered_set<std::uint64_t> taken_;
  std::unordered_set<std::int32_t> spoilt_;  // parts that cannot be closed
  std::unordered_map<std::int32_t, double> area_of_;
  double size_ = 0;                                      // of the mesh's places
  std::unordered_map<std::int32_t, std::int32_t> same_;  // copies of a vertex in one ring
  std::map<std::int32_t, std::vector<Ring>> rings_of_;   // in the order of the parts
  std::vector<FilledHole> filled_;
};

}  // namespace

std::vector<FilledHole> fill_holes(TriangleMesh& mesh, double share,
                                   std::vector<std::int32_t>& origin) {
  return Filling(mesh, share, origin).run();
}

}  // namespace thimble::render
