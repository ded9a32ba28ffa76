#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "hand/sphere_tree.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::scene {

/// A point on a mesh and the smooth normal there.
struct SurfacePoint {
  Eigen::Vector3d p_WS{0, 0, 0};
  Eigen::Vector3d n_W{0, 0, 0};  ///< Vertex normals interpolated over the triangle, unit length.
  std::size_t triangle = 0;
};

/// Finds closest points on a mesh for questions that follow a path: it remembers the triangles near
/// the last question, so that most questions look at a few triangles and none misses the closest.
class SurfaceProbe {
 public:
  /// Takes a mesh with at least one triangle and keeps a reference to it.
  explicit SurfaceProbe(const render::TriangleMesh& mesh);

  /// Finds the point of the mesh that is closest to `p_WQ` (m, finite).
  /// Real-time: never from the servo thread.
  SurfacePoint closest(const Eigen::Vector3d& p_WQ);

 private:
  void gather(const Eigen::Vector3d& p_WQ);
  SurfacePoint closest_candidate(const Eigen::Vector3d& p_WQ) const;

  const render::TriangleMesh& mesh_;
  std::vector<Eigen::Vector3d> normals_;           // of the vertices
  const std::vector<SphereTree::Sphere> spheres_;  // each holds one triangle
  const SphereTree tree_;
  std::vector<std::size_t> candidates_;  // triangles, in rising order
  Eigen::Vector3d gathered_at_{0, 0, 0};
  double slack_ = 0;  // m the question may move before candidates_ is out of date
};

}  // namespace thimble::scene
