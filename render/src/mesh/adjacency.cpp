#include "mesh/adjacency.h"

#include <atomic>
#include <string>
#include <utility>

#include "mesh/half_edges.h"
#include "mesh/mesh_edges.h"
#include "mesh/parallel_split.h"

namespace thimble::render {
namespace {

std::string edge_name(const EdgeUse& use) {
  return "Edge " + std::to_string(use.low) + "-" + std::to_string(use.high);
}

}  // namespace

std::optional<Adjacency> adjacency_if_closed(const TriangleMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!has_three_vertices(mesh, t)) return std::nullopt;
  }
  const HalfEdges half_edges(mesh.triangles, mesh.vertices.size());
  Adjacency neighbours(mesh.triangles.size());
  std::atomic<bool> closed = true;
  parallel_split(mesh.triangles.size(), [&](std::size_t begin, std::size_t end) noexcept {
    for (std::size_t t = begin; t < end; ++t) {
      const auto& corners = mesh.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        // If each side has exactly one side in the opposite direction, each edge has two triangles:
        // a second side in the same direction would be the second opposite of the other.
        const std::int32_t other = half_edges.opposite(corners[k == 2 ? 0 : k + 1], corners[k]);
        neighbours[t][k] = other;
        if (other >= 0) continue;
        closed = false;
        return;
      }
    }
  });
  if (!closed) return std::nullopt;
  return neighbours;
}

driver::Result<Adjacency> find_adjacency(const TriangleMesh& mesh) {
  if (auto closed = adjacency_if_closed(mesh)) return *std::move(closed);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!has_three_vertices(mesh, t)) {
      return driver::Error{"Triangle " + std::to_string(t) +
                           " does not have three different existing vertices. Remove it."};
    }
  }
  Adjacency neighbours(mesh.triangles.size());
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for (std::size_t begin = 0; begin < uses.size();) {
    const std::size_t end = end_of_edge(uses, begin);
    const EdgeUse& first = uses[begin];
    if (end - begin == 1) {
      return driver::Error{edge_name(first) + " belongs only to triangle " +
                           std::to_string(first.triangle) + ", so the mesh has a hole. Close it."};
    }
    if (end - begin > 2) {
      return driver::Error{edge_name(first) + " belongs to " + std::to_string(end - begin) +
                           " triangles. Split the mesh there so that each edge has two."};
    }
    const EdgeUse& second = uses[begin + 1];
    if (first.upward == second.upward) {
      return driver::Error{edge_name(first) + " joins triangles " + std::to_string(first.triangle) +
                           " and " + std::to_string(second.triangle) +
                           ", which have opposite orientation. Reverse one of them."};
    }
    const auto place = [&neighbours](const EdgeUse& use) -> std::int32_t& {
      return neighbours[static_cast<std::size_t>(use.triangle)]
                       [static_cast<std::size_t>(use.corner)];
    };
    place(first) = second.triangle;
    place(second) = first.triangle;
    begin = end;
  }
  return neighbours;
}

std::int32_t find_neighbour(const TriangleMesh& mesh, std::int32_t triangle,
                            std::size_t edge) noexcept {
  const auto own = static_cast<std::size_t>(triangle);
  const std::size_t count = mesh.triangles.size();
  const std::int32_t from = mesh.triangles[own][edge];
  const std::int32_t to = mesh.triangles[own][(edge + 1) % 3];
  const auto names_both = [&mesh, from, to](std::size_t t) noexcept {
    const auto& [a, b, c] = mesh.triangles[t];
    return (a == from || b == from || c == from) && (a == to || b == to || c == to);
  };
  for (std::size_t away = 1; away < count; ++away) {
    if (away <= own && names_both(own - away)) return static_cast<std::int32_t>(own - away);
    if (away < count - own && names_both(own + away)) return static_cast<std::int32_t>(own + away);
  }
  return -1;
}

}  // namespace thimble::render
