#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/mesh_edges.h"
#include "mesh/repair/edge_order.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

// Steps of thicken_sheets: finds the sides of triangles that face each other over the edges of a
// mesh. A triangle t has two sides, 2 t its front and 2 t + 1 its back. A side s has the corners 3
// s to 3 s + 2, in the triangle's order for both. Real-time: never from the servo thread.

/// Returns the corner of a side at a vertex of its triangle.
std::int32_t corner_of(const TriangleMesh& mesh, std::size_t side, std::int32_t vertex);

/// Two sides of triangles that face each other over an edge.
using Wedge = std::pair<std::size_t, std::size_t>;

// Calls `take(edge, wedges)` for each edge: its first side, and the pairs of sides of triangles
// that face each other over it; none at an open edge.
template <class Take>
void for_each_edge(const TriangleMesh& mesh, std::span<const EdgeUse> uses,
                   std::span<const std::int32_t> sources, Take&& take) {
  std::vector<Wedge> wedges;
  for (std::size_t begin = 0; begin < uses.size();) {
    std::size_t end = begin + 1;
    while (end < uses.size() && uses[end].low == uses[begin].low &&
           uses[end].high == uses[begin].high) {
      ++end;
    }
    wedges.clear();
    if (end - begin > 1) {
      const std::vector<EdgeUse> edge =
          around_edge(mesh, uses.subspan(begin, end - begin), sources);
      for (std::size_t i = 0; i < edge.size(); ++i) {
        const EdgeUse& one = edge[i];
        const EdgeUse& next = edge[(i + 1) % edge.size()];
        // The front of a triangle that has the edge upwards faces the next.
        wedges.emplace_back(2 * static_cast<std::size_t>(one.triangle) + (one.upward ? 0 : 1),
                            2 * static_cast<std::size_t>(next.triangle) + (next.upward ? 1 : 0));
      }
    }
    take(uses[begin], wedges);
    begin = end;
  }
}

/// Joins the corners of sides that become one vertex: those connected around it.
Groups join_corners(const TriangleMesh& mesh, std::span<const EdgeUse> uses,
                    std::span<const std::int32_t> sources);

/// A mesh of pieces of triangles, with the source triangle of each.
struct CutMesh {
  TriangleMesh mesh;
  std::vector<std::int32_t> sources;
};

/// Returns the mesh with ambiguous edges cut in the middle. These are edges where two wedges, or
/// front and back of an open edge, are connected at both ends: a thin body would have one edge
/// there for both. In the middle each has its own vertex.
CutMesh with_ambiguous_edges_cut(const TriangleMesh& mesh);

}  // namespace thimble::render
