#include "mesh/repair/open_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>
#include <utility>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Maximum number of vertices along a seam: a bound for hostile files only.
constexpr std::size_t kChainMax = 10000;

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const noexcept {
    std::uint64_t hash = 0;
    for (const std::int64_t x : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
  }
};

// Vertices by place, to find one within the tolerance.
class Places {
 public:
  Places(const std::vector<Vector3d>& vertices, double tolerance)
      : vertices_(vertices), tolerance_(tolerance) {}

  // Returns the vertex with the smallest number within the tolerance of `p`, -1 for none.
  std::int32_t find(const Vector3d& p) const {
    std::int32_t found = -1;
    const Cell middle = cell_of(p);
    for (std::int64_t i = 0; i < 27; ++i) {
      const Cell cell{middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1};
      const auto [first, last] = cells_.equal_range(cell);
      for (auto place = first; place != last; ++place) {
        const std::int32_t v = place->second;
        const bool near = (vertices_[static_cast<std::size_t>(v)] - p).norm() <= tolerance_;
        if (near && (found < 0 || v < found)) found = v;
      }
    }
    return found;
  }

  void add(std::int32_t vertex) {
    cells_.emplace(cell_of(vertices_[static_cast<std::size_t>(vertex)]), vertex);
  }

 private:
  Cell cell_of(const Vector3d& p) const {
    // Far from the origin neighbouring cells may round to one, which then just holds more. The
    // bound keeps the numbers within 64 bits.
    constexpr double kCellMax = 1e18;
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(
          std::clamp(std::floor(p[axis] / tolerance_), -kCellMax, kCellMax));
    }
    return cell;
  }

  const std::vector<Vector3d>& vertices_;
  const double tolerance_;
  std::unordered_multimap<Cell, std::int32_t, CellHash> cells_;
};

// Finds chains of open edges along one open edge.
class Seams {
 public:
  Seams(const TriangleMesh& mesh, const std::vector<EdgeUse>& open, double tolerance)
      : mesh_(mesh), tolerance_(tolerance) {
    for (const EdgeUse& use : open) {
      ends_.emplace(use.low, use.high);
      ends_.emplace(use.high, use.low);
    }
  }

  // Lists the vertices of the chain along the edge from `from` to `to`, in order; empty if there is
  // none. `third` is the opposite corner, whose edges belong to the same triangle.
  std::vector<std::int32_t> chain(std::int32_t from, std::int32_t to, std::int32_t third) const {
    const Vector3d& a = at(from);
    const Vector3d edge = at(to) - a;
    const double squared = edge.squaredNorm();
    std::vector<std::int32_t> vertices;
    std::int32_t current = from;
    double place = 0;
    while (vertices.size() < kChainMax) {
      std::int32_t next = -1;
      double next_place = 1;
      const auto [first, last] = ends_.equal_range(current);
      for (auto other = first; other != last; ++other) {
        const std::int32_t vertex = other->second;
        if (vertex == to && current != from) return vertices;
        if (vertex == to || vertex == third) continue;
        const Vector3d along = at(vertex) - a;
        const double there = along.dot(edge) / squared;
        if (!(there > place && there < next_place)) continue;
        if (!((along - there * edge).norm() <= tolerance_)) continue;
        next = vertex;
        next_place = there;
      }
      if (next < 0) return {};
      vertices.push_back(next);
      current = next;
      place = next_place;
    }
    return {};
  }

 private:
  const Vector3d& at(std::int32_t vertex) const {
    return mesh_.vertices[static_cast<std::size_t>(vertex)];
  }

  const TriangleMesh& mesh_;
  const double tolerance_;
  std::multimap<std::int32_t, std::int32_t> ends_;
};

}  // namespace

std::vector<EdgeUse> open_edges(const TriangleMesh& mesh) {
  std::vector<EdgeUse> open;
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for (std::size_t begin = 0; begin < uses.size();) {
    const std::size_t end = end_of_edge(uses, begin);
    if (end - begin == 1) open.push_back(uses[begin]);
    begin = end;
  }
  return open;
}

std::vector<std::int32_t> weld_open_edges(TriangleMesh& mesh, double tolerance) {
  std::vector<std::int32_t> on_edge;
  for (const EdgeUse& use : open_edges(mesh)) {
    on_edge.push_back(use.low);
    on_edge.push_back(use.high);
  }
  std::sort(on_edge.begin(), on_edge.end());
  on_edge.erase(std::unique(on_edge.begin(), on_edge.end()), on_edge.end());

  std::vector<std::int32_t> replacement(mesh.vertices.size());
  std::iota(replacement.begin(), replacement.end(), 0);
  std::vector<std::int32_t> welded;
  Places places(mesh.vertices, tolerance);
  for (const std::int32_t vertex : on_edge) {
    const auto v = static_cast<std::size_t>(vertex);
    if (!mesh.vertices[v].allFinite()) continue;
    const std::int32_t near = places.find(mesh.vertices[v]);
    if (near < 0) {
      places.add(vertex);
    } else {
      replacement[v] = near;
      welded.push_back(vertex);
    }
  }
  if (welded.empty()) return welded;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::int32_t& v : mesh.triangles[t]) {
      if (v >= 0 && static_cast<std::size_t>(v) < replacement.size()) {
        v = replacement[static_cast<std::size_t>(v)];
      }
    }
  }
  return welded;
}

std::vector<std::int32_t> close_seams(TriangleMesh& mesh, double tolerance,
                                      std::vector<std::int32_t>& origin) {
  const std::vector<EdgeUse> open = open_edges(mesh);
  const Seams seams(mesh, open, tolerance);
  std::vector<bool> touched(mesh.triangles.size(), false);
  std::set<std::pair<std::int32_t, std::int32_t>> closed;
  const auto edge = [](std::int32_t a, std::int32_t b) {
    return std::pair(std::min(a, b), std::max(a, b));
  };
  std::vector<std::int32_t> split;
  for (const EdgeUse& use : open) {
    const auto t = static_cast<std::size_t>(use.triangle);
    // A triangle with several long edges continues in the next round.
    if (touched[t]) continue;
    const auto corner = static_cast<std::size_t>(static_cast<unsigned char>(use.corner));
    const std::int32_t from = mesh.triangles[t][corner];
    const std::int32_t to = mesh.triangles[t][(corner + 1) % 3];
    const std::int32_t third = mesh.triangles[t][(corner + 2) % 3];
    std::vector<std::int32_t> chain = seams.chain(from, to, third);
    if (chain.empty()) continue;
    chain.insert(chain.begin(), from);
    chain.push_back(to);
    // An edge that another seam has closed in this round is no longer open.
    bool stale = closed.contains(edge(from, to));
    for (std::size_t i = 1; i < chain.size(); ++i) {
      stale |= closed.contains(edge(chain[i - 1], chain[i]));
    }
    if (stale) continue;
    closed.insert(edge(from, to));
    for (std::size_t i = 1; i < chain.size(); ++i) closed.insert(edge(chain[i - 1], chain[i]));
    touched[t] = true;
    split.push_back(use.triangle);
    mesh.triangles[t] = {from, chain[1], third};
    for (std::size_t i = 2; i < chain.size(); ++i) {
      mesh.triangles.push_back({chain[i - 1], chain[i], third});
      origin.push_back(origin[t]);
    }
  }
  return split;
}

}  // namespace thimble::render
