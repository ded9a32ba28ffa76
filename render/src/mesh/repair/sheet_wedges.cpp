#include "mesh/repair/sheet_wedges.h"

#include <algorithm>
#include <array>

namespace thimble::render {
namespace {

// Returns whether two wedges of an edge have the same groups of corners at both ends.
bool is_ambiguous(const TriangleMesh& mesh, Groups& groups, const EdgeUse& edge,
                  const std::vector<Wedge>& wedges) {
  std::vector<std::pair<std::int32_t, std::int32_t>> ends;
  const auto add = [&](std::size_t side) {
    ends.emplace_back(groups.find(corner_of(mesh, side, edge.low)),
                      groups.find(corner_of(mesh, side, edge.high)));
  };
  if (wedges.empty()) {
    add(2 * static_cast<std::size_t>(edge.triangle));
    add(2 * static_cast<std::size_t>(edge.triangle) + 1);
  }
  for (const auto& wedge : wedges) add(wedge.first);
  std::sort(ends.begin(), ends.end());
  return std::adjacent_find(ends.begin(), ends.end()) != ends.end();
}

}  // namespace

std::int32_t corner_of(const TriangleMesh& mesh, std::size_t side, std::int32_t vertex) {
  const auto& corners = mesh.triangles[side / 2];
  const std::size_t k = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
  return static_cast<std::int32_t>(3 * side + k);
}

Groups join_corners(const TriangleMesh& mesh, std::span<const EdgeUse> uses,
                    std::span<const std::int32_t> sources) {
  Groups groups(6 * mesh.triangles.size());
  for_each_edge(mesh, uses, sources, [&](const EdgeUse& edge, const auto& wedges) {
    for (const auto& [one, two] : wedges) {
      for (const std::int32_t v : {edge.low, edge.high}) {
        groups.join(corner_of(mesh, one, v), corner_of(mesh, two, v));
      }
    }
  });
  return groups;
}

CutMesh with_ambiguous_edges_cut(const TriangleMesh& mesh) {
  CutMesh done;
  TriangleMesh& cut = done.mesh;
  cut.vertices = mesh.vertices;
  std::vector<std::array<std::int32_t, 3>> middles(mesh.triangles.size(), {-1, -1, -1});
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  Groups groups = join_corners(mesh, uses, {});
  std::size_t at = 0;
  for_each_edge(mesh, uses, {}, [&](const EdgeUse& edge, const auto& wedges) {
    const std::size_t end = end_of_edge(uses, at);
    if (is_ambiguous(mesh, groups, edge, wedges)) {
      for (std::size_t i = at; i < end; ++i) {
        middles[static_cast<std::size_t>(uses[i].triangle)]
               [static_cast<std::size_t>(uses[i].corner)] =
                   static_cast<std::int32_t>(cut.vertices.size());
      }
      cut.vertices.push_back((mesh.vertices[static_cast<std::size_t>(edge.low)] +
                              mesh.vertices[static_cast<std::size_t>(edge.high)]) /
                             2);
    }
    at = end;
  });
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const auto& middle = middles[t];
    // Corners in front of a cut edge on both sides become triangles of their own; the rest is a fan
    // from the first middle, or the triangle itself.
    std::vector<std::int32_t> rest;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t before = (k + 2) % 3;
      if (middle[before] >= 0 && middle[k] >= 0) {
        cut.triangles.push_back({middle[before], corners[k], middle[k]});
      } else {
        rest.push_back(corners[k]);
      }
      if (middle[k] >= 0) rest.push_back(middle[k]);
    }
    const auto first = std::find_if(rest.begin(), rest.end(), [&middle](std::int32_t v) {
      return std::find(middle.begin(), middle.end(), v) != middle.end();
    });
    if (first != rest.end()) std::rotate(rest.begin(), first, rest.end());
    for (std::size_t i = 1; i + 1 < rest.size(); ++i) {
      cut.triangles.push_back({rest[0], rest[i], rest[i + 1]});
    }
    done.sources.resize(cut.triangles.size(), static_cast<std::int32_t>(t));
  }
  return done;
}

}  // namespace thimble::render
