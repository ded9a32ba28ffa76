#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "hand/sphere_tree.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::scene {

/// Point on a mesh with the smooth normal.
struct SurfacePoint {
  Eigen::Vector3d p_WS{0, 0, 0};
  Eigen::Vector3d n_W{0, 0, 0};  ///< Vertex normals interpolated over the triangle, unit length.
  std::size_t triangle = 0;
};

/// Finds closest points on a mesh for queries along a path. It stores the triangles near the last
/// query, so that most queries test few triangles and none misses the closest.
class SurfaceProbe {
 public:
  /// Constructs a probe for a mesh with at least one triangle; keeps a reference to it.
  explicit SurfaceProbe(const render::TriangleMesh& mesh);

  /// Returns the point of the mesh closest to `p_WQ` (m, finite). Real-time: never from the servo
  /// thread.
  SurfacePoint closest(const Eigen::Vector3d& p_WQ);

 private:
  void gather(const Eigen::Vector3d& p_WQ);
  SurfacePoint closest_candidate(const Eigen::Vector3d& p_WQ) const;

  const render::TriangleMesh& mesh_;
  std::vector<Eigen::Vector3d> normals_;           // Vertex normals.
  const std::vector<SphereTree::Sphere> spheres_;  // Each contains one triangle.
  const SphereTree tree_;
  std::vector<std::size_t> candidates_;  // Triangles in ascending order.
  Eigen::Vector3d gathered_at_{0, 0, 0};
  double slack_ = 0;  // Distance that the query may move before candidates_ is out of date, m.
};

}  // namespace thimble::scene
