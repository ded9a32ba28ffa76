#include "mesh/repair/split_fans.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "mesh/mesh_edges.h"
#include "mesh/repair/edge_order.h"
#include "mesh/repair/out_array.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using Pair = std::pair<EdgeUse, EdgeUse>;

// An edge whose ends its pairs still share is cut in the middle. After this number of rounds, a
// mesh keeps such edges.
constexpr int kCutRoundsMax = 4;

// Returns the pairs of sides with matter between them at an edge of many triangles; empty if matter
// and gap do not alternate around it.
std::vector<Pair> matter_pairs(const TriangleMesh& mesh, std::span<const EdgeUse> uses) {
  std::vector<Pair> pairs;
  const std::size_t count = uses.size();
  if (count % 2 != 0) return pairs;
  const std::vector<EdgeUse> around = around_edge(mesh, uses);
  for (std::size_t i = 0; i < count; ++i) {
    const EdgeUse& one = around[i];
    const EdgeUse& next = around[(i + 1) % count];
    if (one.upward == next.upward) return {};
    // The outer side of a triangle that has the edge upwards faces the next: between them is a gap.
    if (!one.upward) pairs.emplace_back(one, next);
  }
  return pairs;
}

// Connections at each edge: pairs, and for edges that cannot be split all their sides.
struct Links {
  std::vector<Pair> pairs;
  std::vector<std::int32_t> parted;       // a triangle at each edge of several pairs
  std::vector<std::vector<Pair>> crowds;  // pairs of each such edge
  std::size_t unclear = 0;                // edges with an even number of triangles where matter and
                                          // gap do not alternate
};

Links find_links(const TriangleMesh& mesh) {
  Links links;
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for (std::size_t begin = 0; begin < uses.size();) {
    const std::size_t end = end_of_edge(uses, begin);
    const std::span<const EdgeUse> edge(uses.data() + begin, end - begin);
    std::vector<Pair> parted;
    if (edge.size() > 2) parted = matter_pairs(mesh, edge);
    if (parted.empty()) {
      for (std::size_t i = 1; i < edge.size(); ++i) links.pairs.emplace_back(edge[i - 1], edge[i]);
      links.unclear += edge.size() > 2 && edge.size() % 2 == 0;
    } else {
      links.pairs.insert(links.pairs.end(), parted.begin(), parted.end());
      links.parted.push_back(edge.front().triangle);
      links.crowds.push_back(std::move(parted));
    }
    begin = end;
  }
  return links;
}

// Turns triangles according to rays, if that makes the sides of more edges match. Returns those
// turned.
std::vector<std::int32_t> turn_by_rays(TriangleMesh& mesh, Links& links) {
  if (links.unclear == 0) return {};
  TriangleMesh turned = mesh;
  std::vector<std::int32_t> which;
  const OutArray out = compute_out_array(mesh);
  for (std::size_t t = 0; t < out.size(); ++t) {
    if (out[t] >= 0) continue;
    std::swap(turned.triangles[t][1], turned.triangles[t][2]);
    which.push_back(static_cast<std::int32_t>(t));
  }
  Links better = find_links(turned);
  if (better.unclear >= links.unclear) return {};
  mesh = std::move(turned);
  links = std::move(better);
  return which;
}

std::size_t place_of(const TriangleMesh& mesh, std::int32_t triangle, std::int32_t vertex) {
  const auto& corners = mesh.triangles[static_cast<std::size_t>(triangle)];
  return corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
}

// Adds a copy of a vertex, `steps` roundings towards the middle of a triangle that will use it.
std::int32_t moved_copy(TriangleMesh& mesh, const Vector3d& from, const Vector3d& towards,
                        int steps) {
  Vector3d p = from;
  Eigen::Index axis = 0;
  towards.cwiseAbs().maxCoeff(&axis);
  const double far = towards[axis] > 0 ? HUGE_VAL : -HUGE_VAL;
  for (int i = 0; i < steps; ++i) p[axis] = std::nextafter(p[axis], far);
  mesh.vertices.push_back(p);
  return static_cast<std::int32_t>(mesh.vertices.size() - 1);
}

Vector3d way_in(const TriangleMesh& mesh, std::size_t triangle, const Vector3d& from) {
  Vector3d towards(0, 0, 0);
  for (const std::int32_t v : mesh.triangles[triangle]) {
    towards += mesh.vertices[static_cast<std::size_t>(v)] - from;
  }
  return towards;
}

// Gives every fan but the first of each vertex a copy. Returns the vertices, once for each copy.
std::vector<std::int32_t> split_vertices(TriangleMesh& mesh, const Links& links) {
  Groups corners(3 * mesh.triangles.size());
  const auto corner_at = [&mesh](std::int32_t t, std::int32_t vertex) {
    return 3 * t + static_cast<std::int32_t>(place_of(mesh, t, vertex));
  };
  for (const auto& [one, two] : links.pairs) {
    for (const std::int32_t vertex : {one.low, one.high}) {
      corners.join(corner_at(one.triangle, vertex), corner_at(two.triangle, vertex));
    }
  }
  std::vector<std::int32_t> doubled;
  std::vector<int> fans(mesh.vertices.size(), 0);
  std::vector<std::int32_t> vertex_of(3 * mesh.triangles.size(), -1);
  for (std::size_t corner = 0; corner < vertex_of.size(); ++corner) {
    if (!has_three_vertices(mesh, corner / 3)) continue;
    const std::int32_t vertex = mesh.triangles[corner / 3][corner % 3];
    const auto root = static_cast<std::size_t>(corners.find(static_cast<std::int32_t>(corner)));
    if (root == corner) {
      const int earlier = fans[static_cast<std::size_t>(vertex)]++;
      vertex_of[corner] = vertex;
      if (earlier > 0) {
        const Vector3d from = mesh.vertices[static_cast<std::size_t>(vertex)];
        vertex_of[corner] = moved_copy(mesh, from, way_in(mesh, corner / 3, from), earlier);
        doubled.push_back(vertex);
      }
    }
    // A group's root is its smallest corner, so it has been visited before.
    mesh.triangles[corner / 3][corner % 3] = vertex_of[root];
  }
  return doubled;
}

// Cuts edges that several pairs still share in the middle, at a vertex for each pair. Returns
// whether there were any.
bool cut_shared_edges(TriangleMesh& mesh, std::vector<std::int32_t>& origin) {
  const Links links = find_links(mesh);
  std::vector<bool> touched(mesh.triangles.size(), false);
  const auto is_touched = [&touched](const Pair& pair) {
    return touched[static_cast<std::size_t>(pair.first.triangle)] ||
           touched[static_cast<std::size_t>(pair.second.triangle)];
  };
  for (const std::vector<Pair>& crowd : links.crowds) {
    // A triangle with several such edges continues in the next round.
    if (std::any_of(crowd.begin(), crowd.end(), is_touched)) continue;
    int steps = 0;
    for (const Pair& pair : crowd) {
      const Vector3d middle = (mesh.vertices[static_cast<std::size_t>(pair.first.low)] +
                               mesh.vertices[static_cast<std::size_t>(pair.first.high)]) /
                              2;
      const auto first = static_cast<std::size_t>(pair.first.triangle);
      const std::int32_t vertex = moved_copy(mesh, middle, way_in(mesh, first, middle), steps++);
      for (const EdgeUse& use : {pair.first, pair.second}) {
        const auto t = static_cast<std::size_t>(use.triangle);
        touched[t] = true;
        const auto corner = static_cast<std::size_t>(static_cast<unsigned char>(use.corner));
        std::array<std::int32_t, 3> rest = mesh.triangles[t];
        rest[corner] = vertex;
        mesh.triangles[t][(corner + 1) % 3] = vertex;
        mesh.triangles.push_back(rest);
        origin.push_back(origin[t]);
      }
    }
  }
  return !links.crowds.empty();
}

}  // namespace

SplitFans split_fans(TriangleMesh& mesh, std::vector<std::int32_t>& origin) {
  SplitFans done;
  Links links = find_links(mesh);
  done.turned = turn_by_rays(mesh, links);
  done.parted_edges = links.parted;
  done.vertices = split_vertices(mesh, links);
  for (int round = 0; round < kCutRoundsMax && !done.parted_edges.empty(); ++round) {
    if (!cut_shared_edges(mesh, origin)) break;
    split_vertices(mesh, find_links(mesh));
  }
  return done;
}

}  // namespace thimble::render
