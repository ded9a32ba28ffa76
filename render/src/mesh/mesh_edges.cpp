#include "mesh/mesh_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace thimble::render {

std::vector<EdgeUse> sorted_edge_uses(const TriangleMesh& mesh) {
  // Sides are first distributed to their smaller vertex, in the order of the triangles; then only
  // the few of one vertex have to be sorted.
  std::vector<std::size_t> begin(mesh.vertices.size() + 1, 0);
  const auto for_each_side = [&mesh](auto&& take) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (!has_three_vertices(mesh, t)) continue;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::int32_t from = mesh.triangles[t][corner];
        const std::int32_t to = mesh.triangles[t][corner == 2 ? 0 : corner + 1];
        take(EdgeUse{std::min(from, to), std::max(from, to), static_cast<std::int32_t>(t),
                     static_cast<std::int8_t>(corner), from < to});
      }
    }
  };
  for_each_side([&begin](const EdgeUse& use) { ++begin[static_cast<std::size_t>(use.low) + 1]; });
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<EdgeUse> uses(begin.back());
  // Afterwards `begin` of a vertex is its end, and so the begin of the next.
  for_each_side(
      [&](const EdgeUse& use) { uses[begin[static_cast<std::size_t>(use.low)]++] = use; });
  std::size_t first = 0;
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    std::sort(uses.begin() + static_cast<std::ptrdiff_t>(first),
              uses.begin() + static_cast<std::ptrdiff_t>(begin[v]),
              [](const EdgeUse& a, const EdgeUse& b) {
                return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle);
              });
    first = begin[v];
  }
  return uses;
}

Groups::Groups(std::size_t size) : parent_(size) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

std::int32_t Groups::find(std::int32_t member) {
  auto at = [this](std::int32_t i) -> std::int32_t& {
    return parent_[static_cast<std::size_t>(i)];
  };
  while (at(member) != member) {
    at(member) = at(at(member));
    member = at(member);
  }
  return member;
}

void Groups::join(std::int32_t a, std::int32_t b) {
  a = find(a);
  b = find(b);
  parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

}  // namespace thimble::render
