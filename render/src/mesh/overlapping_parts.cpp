#include "mesh/overlapping_parts.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "mesh/mesh_edges.h"
#include "mesh/repair/orient_mesh.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

struct Component {
  Vector3d min = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d max = -min;
  double volume = 0;      // negative for a cavity
  std::size_t group = 0;  // component to which this one belongs: itself, or the solid around
  bool overlaps = false;

  bool contains(const Component& other) const {
    return (min.array() <= other.min.array()).all() && (max.array() >= other.max.array()).all();
  }
};

// Returns whether all triangles are connected over vertices.
bool is_connected(const TriangleMesh& mesh) {
  std::vector<std::int32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t v) {
    while (parent[static_cast<std::size_t>(v)] != v) {
      auto& up = parent[static_cast<std::size_t>(v)];
      up = parent[static_cast<std::size_t>(up)];
      v = up;
    }
    return v;
  };
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t k = 1; k < 3; ++k) {
      parent[static_cast<std::size_t>(root(triangle[k]))] = root(triangle[0]);
    }
  }
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
    return root(triangle[0]) == root(mesh.triangles[0][0]);
  });
}

std::vector<Component> measure(const TriangleMesh& mesh, const MeshComponents& components) {
  std::vector<Component> found(components.count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Component& own = found[static_cast<std::size_t>(components.component_of[t])];
    std::array<Vector3d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][k])];
      own.min = own.min.cwiseMin(p[k]);
      own.max = own.max.cwiseMax(p[k]);
    }
    // Relative to the first vertex of the mesh, so that distance loses no digits.
    const Vector3d& o = mesh.vertices.front();
    own.volume += (p[0] - o).dot((p[1] - o).cross(p[2] - o));
  }
  return found;
}

// Assigns each cavity to the smallest solid around it.
void assign_cavities(std::vector<Component>& components) {
  for (std::size_t i = 0; i < components.size(); ++i) {
    components[i].group = i;
    if (components[i].volume > 0) continue;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < components.size(); ++k) {
      if (!(components[k].volume > 0) || !components[k].contains(components[i])) continue;
      const double size = (components[k].max - components[k].min).norm();
      if (size < smallest) {
        smallest = size;
        components[i].group = k;
      }
    }
  }
}

// Marks the solids whose boxes overlap or touch. Sorted along x, so that only neighbours are
// compared.
void mark_overlaps(std::vector<Component>& components) {
  std::vector<std::size_t> order;
  double largest = 0;
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (components[i].group != i) continue;
    order.push_back(i);
    largest = std::max({largest, components[i].min.cwiseAbs().maxCoeff(),
                        components[i].max.cwiseAbs().maxCoeff()});
  }
  const double rounding = 1e-9 * largest;  // [chosen: boxes that touch count as overlapping]
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return components[a].min.x() < components[b].min.x();
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    Component& a = components[order[i]];
    for (std::size_t k = i + 1; k < order.size(); ++k) {
      Component& b = components[order[k]];
      if (b.min.x() > a.max.x() + rounding) break;
      const bool apart = (b.min.array() > a.max.array() + rounding).any() ||
                         (a.min.array() > b.max.array() + rounding).any();
      if (!apart) a.overlaps = b.overlaps = true;
    }
  }
}

}  // namespace

std::vector<MeshPart> overlapping_parts(const TriangleMesh& mesh) {
  if (mesh.triangles.empty() || is_connected(mesh)) return {};
  TriangleMesh oriented = mesh;
  orient_mesh(oriented);
  const MeshComponents components = find_components(oriented, sorted_edge_uses(oriented));
  std::vector<Component> measured = measure(oriented, components);
  assign_cavities(measured);
  mark_overlaps(measured);
  // Part 0 is that of all solids apart.
  std::vector<std::size_t> part_of(measured.size(), 0);
  std::size_t count = 1;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (measured[i].group == i && measured[i].overlaps) part_of[i] = count++;
  }
  if (count == 1) return {};
  std::vector<MeshPart> parts(count);
  std::vector<std::vector<std::size_t>> triangles(count);
  for (std::size_t t = 0; t < oriented.triangles.size(); ++t) {
    const auto component = static_cast<std::size_t>(components.component_of[t]);
    triangles[part_of[measured[component].group]].push_back(t);
  }
  std::vector<std::int32_t> number(oriented.vertices.size(), -1);
  for (std::size_t i = 0; i < count; ++i) {
    MeshPart& part = parts[i];
    for (const std::size_t t : triangles[i]) {
      auto corners = oriented.triangles[t];
      for (std::int32_t& corner : corners) {
        std::int32_t& own = number[static_cast<std::size_t>(corner)];
        if (own < 0) {
          own = static_cast<std::int32_t>(part.mesh.vertices.size());
          part.mesh.vertices.push_back(oriented.vertices[static_cast<std::size_t>(corner)]);
        }
        corner = own;
      }
      part.mesh.triangles.push_back(corners);
      part.triangles.push_back(static_cast<std::int32_t>(t));
    }
    for (const std::size_t t : triangles[i]) {
      for (const std::int32_t corner : oriented.triangles[t]) {
        number[static_cast<std::size_t>(corner)] = -1;
      }
    }
  }
  if (parts.front().triangles.empty()) parts.erase(parts.begin());
  return parts;
}

}  // namespace thimble::render
