#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hand/surface_probe.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::scene {

/// Finds paths from one point of a surface to another: over the surface where it hangs together,
/// else in the free over what lies between.
class SurfaceRoute {
 public:
  /// Takes a mesh with at least one triangle (W, m) and its probe, and keeps references to both.
  /// Real-time: never from the servo thread.
  SurfaceRoute(const render::TriangleMesh& mesh_W, SurfaceProbe& probe);
  ~SurfaceRoute();

  /// Returns the path as points not far apart, from the one to the other (W, m), nearly the
  /// shortest over the surface; empty if the surface does not hang together between them.
  std::vector<Eigen::Vector3d> over_surface(const Eigen::Vector3d& p_from,
                                            const Eigen::Vector3d& p_to);

  /// Returns the corners of a path that leaves the surface, passes what lies between, and comes
  /// back. It stays outside on a grid of some 30 cells across. Empty if there is none: the goal
  /// lies inside another part.
  std::vector<Eigen::Vector3d> over_the_gap(const Eigen::Vector3d& p_from,
                                            const Eigen::Vector3d& p_to);

 private:
  class Graph;

  void straighten(std::vector<Eigen::Vector3d>& path);
  bool is_outside(const Eigen::Vector3d& p_W);
  bool is_free(const Eigen::Vector3d& p_from, const Eigen::Vector3d& p_to);

  const render::TriangleMesh& mesh_;
  SurfaceProbe& probe_;
  std::unique_ptr<Graph> graph_;  // made when it is first needed
  Eigen::AlignedBox3d box_;       // of the mesh and a little beyond, m
  double size_ = 0;               // diagonal of the mesh's box, m
};

}  // namespace thimble::scene
