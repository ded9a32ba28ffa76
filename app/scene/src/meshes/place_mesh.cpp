#include "meshes/place_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "thimble/render/mesh/mesh_file.h"

namespace thimble::scene {

MeshPlacement placement_of(const render::TriangleMesh& mesh, const SceneObject& object) {
  // The box of the mesh as it lies in its file gives the size: turning an object must not change
  // it.
  Eigen::AlignedBox3d file_box;
  Eigen::AlignedBox3d turned_box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    file_box.extend(vertex);
    turned_box.extend(object.R_WO * vertex);
  }
  const double largest = file_box.sizes().maxCoeff();
  const double scale =
      object.size && largest > 0 ? *object.size / largest : object.scale.value_or(1);
  return {.scale = scale, .p_WM = object.p_WO - scale * turned_box.center()};
}

render::TriangleMesh place_mesh(const render::TriangleMesh& mesh, const SceneObject& object) {
  const MeshPlacement place = placement_of(mesh, object);
  return render::placed(mesh, place.scale, object.R_WO, place.p_WM);
}

render::PagedPlace place_pages(const render::PageFile& file, const SceneObject& object) {
  Eigen::Vector3d low, high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[static_cast<Eigen::Index>(axis)] = double{file.whole().min[axis]};
    high[static_cast<Eigen::Index>(axis)] = double{file.whole().max[axis]};
  }
  const double step = file.lattice().step;
  const Eigen::Vector3d center = file.lattice().origin + step * 0.5 * (low + high);
  const double largest = step * (high - low).maxCoeff();
  const double scale =
      object.size && largest > 0 ? *object.size / largest : object.scale.value_or(1);
  return {
      .scale = scale, .R_WM = object.R_WO, .p_WM = object.p_WO - scale * (object.R_WO * center)};
}

double side_of_pages(const render::PageFile& file, const render::PagedPlace& place) {
  double largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    largest = std::max(largest, double{file.whole().max[axis]} - double{file.whole().min[axis]});
  }
  return std::abs(place.scale) * file.lattice().step * largest;
}

}  // namespace thimble::scene
