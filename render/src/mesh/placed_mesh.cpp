#include "thimble/render/mesh/mesh_file.h"

#include <utility>

namespace thimble::render {

TriangleMesh placed(const TriangleMesh& mesh, double scale, const Eigen::Matrix3d& R_WO,
                    const Eigen::Vector3d& p_WO) {
  TriangleMesh in_world = mesh;
  for (Eigen::Vector3d& vertex : in_world.vertices) {
    const Eigen::Vector3d scaled = scale * vertex;
    vertex = R_WO * scaled + p_WO;
  }
  if (scale < 0) {
    for (auto& triangle : in_world.triangles) std::swap(triangle[1], triangle[2]);
  }
  return in_world;
}

}  // namespace thimble::render
