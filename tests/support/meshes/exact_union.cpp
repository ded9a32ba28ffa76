#include "support/meshes/exact_union.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace thimble::support {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Exact = CGAL::Surface_mesh<Kernel::Point_3>;
using Rounded = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

template <class Mesh>
Mesh surface_of(const render::TriangleMesh& mesh) {
  Mesh surface;
  std::vector<typename Mesh::Vertex_index> vertices;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    vertices.push_back(surface.add_vertex({p.x(), p.y(), p.z()}));
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    surface.add_face(vertices[static_cast<std::size_t>(a)], vertices[static_cast<std::size_t>(b)],
                     vertices[static_cast<std::size_t>(c)]);
  }
  return surface;
}

}  // namespace

struct ExactUnion::Surface {
  Exact mesh;
};

ExactUnion::ExactUnion() : surface_(std::make_unique<Surface>()) {}
ExactUnion::~ExactUnion() = default;

bool ExactUnion::add(const render::TriangleMesh& solid) {
  Exact one = surface_of<Exact>(solid);
  if (surface_->mesh.is_empty()) {
    surface_->mesh = std::move(one);
    return true;
  }
  // Corefinement changes its input.
  Exact sum = surface_->mesh, both;
  if (!pmp::corefine_and_compute_union(sum, one, both)) return false;
  both.collect_garbage();
  // Otherwise each number keeps all steps of its computation.
  for (const auto v : both.vertices()) CGAL::exact(both.point(v));
  surface_->mesh = std::move(both);
  return true;
}

render::TriangleMesh ExactUnion::mesh() const {
  const Exact& exact = surface_->mesh;
  render::TriangleMesh mesh;
  std::vector<std::int32_t> numbers(exact.num_vertices());
  for (const auto v : exact.vertices()) {
    numbers[v] = static_cast<std::int32_t>(mesh.vertices.size());
    const auto p = CGAL::exact(exact.point(v));
    mesh.vertices.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()),
                               CGAL::to_double(p.z()));
  }
  for (const auto f : exact.faces()) {
    std::array<std::int32_t, 3> corners{};
    std::size_t k = 0;
    for (const auto v : exact.vertices_around_face(exact.halfedge(f))) corners.at(k++) = numbers[v];
    mesh.triangles.push_back(corners);
  }
  return mesh;
}

bool ExactUnion::exact_in_doubles() const {
  const Exact& exact = surface_->mesh;
  for (const auto v : exact.vertices()) {
    const auto p = CGAL::exact(exact.point(v));
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] != CGAL::to_double(p[axis])) return false;
    }
  }
  return true;
}

bool ExactUnion::intersects_itself() const {
  return pmp::does_self_intersect(surface_of<Rounded>(mesh()));
}

}  // namespace thimble::support
