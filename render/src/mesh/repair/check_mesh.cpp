#include "thimble/render/mesh/check_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "mesh/mesh_edges.h"
#include "mesh/repair/orient_mesh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Kind = MeshFault::Kind;

// Checks one mesh and collects findings; each function adds the kind in its name.
class Inspection {
 public:
  explicit Inspection(const TriangleMesh& mesh) : mesh_(mesh), uses_(sorted_edge_uses(mesh)) {}

  MeshFindings run() {
    found_.vertices = mesh_.vertices.size();
    found_.triangles = mesh_.triangles.size();
    look_at_vertices();
    look_at_triangles();
    look_for_duplicates();
    look_at_edges();
    look_at_fans();
    look_at_components();
    // Faults are sorted by kind, in whatever order they were found.
    std::sort(found_.faults.begin(), found_.faults.end(),
              [](const MeshFault& a, const MeshFault& b) { return a.kind < b.kind; });
    return std::move(found_);
  }

 private:
  const Vector3d& at(std::int32_t vertex) const {
    return mesh_.vertices[static_cast<std::size_t>(vertex)];
  }

  static std::string text(const Vector3d& p) {
    std::ostringstream stream;
    stream << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
    return stream.str();
  }

  std::string triangle_text(std::size_t t) const {
    std::string words = "triangle " + std::to_string(t);
    if (has_three_vertices(mesh_, t)) {
      const auto& [a, b, c] = mesh_.triangles[t];
      words += " near " + text((at(a) + at(b) + at(c)) / 3);
    }
    return words;
  }

  std::string edge_text(const EdgeUse& use) const {
    return "edge " + std::to_string(use.low) + "-" + std::to_string(use.high) + " near " +
           text((at(use.low) + at(use.high)) / 2);
  }

  template <class Where>
  void add(Kind kind, const FaultPlace& place, Where where) {
    for (MeshFault& fault : found_.faults) {
      if (fault.kind == kind) {
        ++fault.count;
        if (fault.places.size() < kPlacesMax) fault.places.push_back(place);
        return;
      }
    }
    found_.faults.push_back({kind, 1, where(), {place}});
  }

  void look_at_vertices() {
    std::vector<bool> used(mesh_.vertices.size(), false);
    for (const auto& triangle : mesh_.triangles) {
      for (const std::int32_t v : triangle) {
        if (v >= 0 && static_cast<std::size_t>(v) < used.size()) {
          used[static_cast<std::size_t>(v)] = true;
        }
      }
    }
    Eigen::AlignedBox3d box;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      const Vector3d& p = mesh_.vertices[v];
      if (p.allFinite()) {
        box.extend(p);
      } else {
        add(Kind::kNotFinite, {static_cast<std::int32_t>(v), -1, -1},
            [&] { return "vertex " + std::to_string(v); });
      }
      found_.unused_vertices += !used[v];
    }
    if (!box.isEmpty()) {
      found_.box_min = box.min();
      found_.box_max = box.max();
    }
  }

  void look_at_triangles() {
    const Vector3d middle = (found_.box_min + found_.box_max) / 2;
    const auto size = static_cast<std::int64_t>(mesh_.vertices.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto where = [&] { return triangle_text(t); };
      const auto& triangle = mesh_.triangles[t];
      if (std::any_of(triangle.begin(), triangle.end(),
                      [size](std::int32_t v) { return v < 0 || v >= size; })) {
        add(Kind::kIndexOutOfRange, triangle, where);
        continue;
      }
      if (!has_three_vertices(mesh_, t)) {
        add(Kind::kDegenerateTriangle, triangle, where);
        continue;
      }
      const Vector3d& a = at(triangle[0]);
      const Vector3d& b = at(triangle[1]);
      const Vector3d& c = at(triangle[2]);
      if (!a.allFinite() || !b.allFinite() || !c.allFinite()) continue;
      const double twice_area = (b - a).cross(c - a).stableNorm();
      const double longest =
          std::max({(b - a).stableNorm(), (c - b).stableNorm(), (a - c).stableNorm()});
      if (!(twice_area > kFlatness * longest * longest))
        add(Kind::kDegenerateTriangle, triangle, where);
      found_.area += twice_area / 2;
      found_.volume += (a - middle).dot((b - middle).cross(c - middle)) / 6;
    }
  }

  // Triangles with the same corners share their edge of the two smaller ones.
  void look_for_duplicates() {
    std::vector<std::pair<std::int32_t, std::size_t>> thirds;  // the largest corner, the triangle
    for (std::size_t begin = 0; begin < uses_.size();) {
      const std::size_t end = end_of_edge(uses_, begin);
      thirds.clear();
      for (std::size_t i = begin; i < end && end - begin > 1; ++i) {
        const auto t = static_cast<std::size_t>(uses_[i].triangle);
        const auto third = static_cast<std::size_t>(uses_[i].corner + 2) % 3;
        const std::int32_t vertex = mesh_.triangles[t][third];
        if (vertex > uses_[i].high) thirds.emplace_back(vertex, t);
      }
      std::sort(thirds.begin(), thirds.end());
      for (std::size_t i = 1; i < thirds.size(); ++i) {
        if (thirds[i].first != thirds[i - 1].first) continue;
        const std::size_t t = thirds[i].second;
        add(Kind::kDuplicateTriangle, mesh_.triangles[t], [&] { return triangle_text(t); });
      }
      begin = end;
    }
  }

  void look_at_edges() {
    double sum = 0;
    found_.edge_min = std::numeric_limits<double>::infinity();
    for (std::size_t begin = 0; begin < uses_.size();) {
      const std::size_t end = end_of_edge(uses_, begin);
      const EdgeUse& use = uses_[begin];
      const double length = (at(use.low) - at(use.high)).stableNorm();
      sum += length;
      found_.edge_min = std::min(found_.edge_min, length);
      found_.edge_max = std::max(found_.edge_max, length);
      ++found_.edges;
      const FaultPlace place{use.low, use.high, -1};
      const auto where = [&] { return edge_text(use); };
      if (end - begin == 1) add(Kind::kOpenEdge, place, where);
      if (end - begin > 2) add(Kind::kNonManifoldEdge, place, where);
      if (end - begin == 2 && use.upward == uses_[begin + 1].upward)
        add(Kind::kFlippedEdge, place, where);
      begin = end;
    }
    if (found_.edges == 0) found_.edge_min = 0;
    found_.edge_mean = found_.edges == 0 ? 0 : sum / static_cast<double>(found_.edges);
    found_.euler_characteristic = static_cast<long>(found_.vertices - found_.unused_vertices) -
                                  static_cast<long>(found_.edges) +
                                  static_cast<long>(found_.triangles);
  }

  // Joins the corners at each vertex over the edges that leave it: one group is one fan.
  void look_at_fans() {
    Groups corners(3 * mesh_.triangles.size());
    const auto corner_at = [this](std::int32_t t, std::int32_t vertex) {
      const auto& triangle = mesh_.triangles[static_cast<std::size_t>(t)];
      const auto place = std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin();
      return 3 * t + static_cast<std::int32_t>(place);
    };
    for (std::size_t begin = 0; begin < uses_.size();) {
      const std::size_t end = end_of_edge(uses_, begin);
      for (std::size_t i = begin + 1; i < end; ++i) {
        for (const std::int32_t vertex : {uses_[begin].low, uses_[begin].high}) {
          corners.join(corner_at(uses_[begin].triangle, vertex),
                       corner_at(uses_[i].triangle, vertex));
        }
      }
      begin = end;
    }
    std::vector<int> fans(mesh_.vertices.size(), 0);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (!has_three_vertices(mesh_, t)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::int32_t>(3 * t + k);
        const std::int32_t vertex = mesh_.triangles[t][k];
        if (corners.find(corner) == corner && ++fans[static_cast<std::size_t>(vertex)] == 2) {
          add(Kind::kNonManifoldVertex, {vertex, -1, -1},
              [&] { return "vertex " + std::to_string(vertex) + " at " + text(at(vertex)); });
        }
      }
    }
  }

  void look_at_components() {
    const MeshComponents parts = find_components(mesh_, uses_);
    found_.components = parts.count;
    for (std::size_t part = 0; part < parts.count; ++part) {
      if (!parts.inside_out[part]) continue;
      const auto first =
          static_cast<std::size_t>(std::find(parts.component_of.begin(), parts.component_of.end(),
                                             static_cast<std::int32_t>(part)) -
                                   parts.component_of.begin());
      add(Kind::kInsideOut, mesh_.triangles[first],
          [&] { return "the component of " + triangle_text(first); });
    }
  }

  const TriangleMesh& mesh_;
  const std::vector<EdgeUse> uses_;
  MeshFindings found_;
};

}  // namespace

MeshFindings check_mesh(const TriangleMesh& mesh) {
  return Inspection(mesh).run();
}

}  // namespace thimble::render
