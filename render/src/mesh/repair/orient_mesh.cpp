#include "mesh/repair/orient_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "mesh/mesh_edges.h"
#include "mesh/segment_crossing.h"

namespace thimble::render {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// Enough that components which overlap by half are told apart from nested ones, few enough that a
// file of many small parts is checked in seconds.
constexpr std::size_t kWitnesses = 8;

struct Component {
  std::vector<std::size_t> triangles;
  AlignedBox3d box;
  double volume = 0;  // six times the signed volume
};

const Vector3d& corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t k) {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][k])];
}

bool is_finite(const TriangleMesh& mesh, std::size_t triangle) {
  return corner(mesh, triangle, 0).allFinite() && corner(mesh, triangle, 1).allFinite() &&
         corner(mesh, triangle, 2).allFinite();
}

bool lies_in(const TriangleMesh& mesh, const Component& inner, const Component& outer) {
  if (!outer.box.contains(inner.box)) return false;
  const std::size_t step = std::max<std::size_t>(1, inner.triangles.size() / kWitnesses);
  for (std::size_t i = 0; i < inner.triangles.size(); i += step) {
    const Vector3d& witness = corner(mesh, inner.triangles[i], 0);
    Vector3d far = witness;
    far.x() = outer.box.max().x() + outer.box.diagonal().norm();
    std::size_t crossings = 0;
    for (const std::size_t t : outer.triangles) {
      crossings += crossing(witness, far, corner(mesh, t, 0), corner(mesh, t, 1),
                            corner(mesh, t, 2)) != Crossing::kNone;
    }
    if (crossings % 2 == 0) return false;
  }
  return true;
}

std::vector<Component> collect(const TriangleMesh& mesh, const MeshComponents& found) {
  std::vector<Component> components(found.count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!has_three_vertices(mesh, t) || !is_finite(mesh, t)) continue;
    Component& component = components[static_cast<std::size_t>(found.component_of[t])];
    component.triangles.push_back(t);
    for (std::size_t k = 0; k < 3; ++k) component.box.extend(corner(mesh, t, k));
  }
  for (Component& component : components) {
    // Volumes are taken about the component's own middle: far from the origin they would drown.
    if (component.triangles.empty()) continue;
    const Vector3d middle = component.box.center();
    for (const std::size_t t : component.triangles) {
      component.volume +=
          (corner(mesh, t, 0) - middle)
              .dot((corner(mesh, t, 1) - middle).cross(corner(mesh, t, 2) - middle));
    }
  }
  return components;
}

}  // namespace

MeshComponents find_components(const TriangleMesh& mesh) {
  MeshComponents found;
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  Groups groups(mesh.triangles.size());
  for (std::size_t begin = 0; begin < uses.size();) {
    const std::size_t end = end_of_edge(uses, begin);
    for (std::size_t i = begin + 1; i < end; ++i) {
      groups.join(uses[begin].triangle, uses[i].triangle);
    }
    begin = end;
  }
  found.component_of.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto root = static_cast<std::size_t>(groups.find(static_cast<std::int32_t>(t)));
    found.component_of[t] =
        root == t ? static_cast<std::int32_t>(found.count++) : found.component_of[root];
  }

  found.closed.assign(found.count, true);
  const auto component_of = [&found](std::int32_t t) {
    return static_cast<std::size_t>(found.component_of[static_cast<std::size_t>(t)]);
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!has_three_vertices(mesh, t) || !is_finite(mesh, t)) {
      found.closed[component_of(static_cast<std::int32_t>(t))] = false;
    }
  }
  for (std::size_t begin = 0; begin < uses.size();) {
    const std::size_t end = end_of_edge(uses, begin);
    if (end - begin != 2 || uses[begin].upward == uses[begin + 1].upward) {
      found.closed[component_of(uses[begin].triangle)] = false;
    }
    begin = end;
  }

  const std::vector<Component> components = collect(mesh, found);
  found.inside_out.assign(found.count, false);
  for (std::size_t i = 0; i < found.count; ++i) {
    if (!found.closed[i]) continue;
    bool cavity = false;
    for (std::size_t j = 0; j < found.count; ++j) {
      if (j != i && found.closed[j] && lies_in(mesh, components[i], components[j])) {
        cavity = !cavity;
      }
    }
    found.inside_out[i] = cavity ? components[i].volume > 0 : components[i].volume < 0;
  }
  return found;
}

}  // namespace thimble::render
