#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hand/surface_probe.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::scene {

/// Finds paths from one point of a surface to another: over the surface if it is connected,
/// otherwise through free space.
class SurfaceRoute {
 public:
  /// Constructs it for a mesh with at least one triangle (W, m) and its probe; keeps references to
  /// both. Real-time: never from the servo thread.
  SurfaceRoute(const render::TriangleMesh& mesh_W, SurfaceProbe& probe);
  ~SurfaceRoute();

  /// Returns the path as closely spaced points from one point to the other (W, m), nearly the
  /// shortest over the surface; empty if the surface is not connected between them.
  std::vector<Eigen::Vector3d> over_surface(const Eigen::Vector3d& p_from,
                                            const Eigen::Vector3d& p_to);

  /// Returns the corners of a path that leaves the surface, passes over the space between, and
  /// returns. It stays outside of the mesh on a grid of about 30 cells across. Empty if there is
  /// none because the goal is inside another part.
  std::vector<Eigen::Vector3d> through_free_space(const Eigen::Vector3d& p_from,
                                                  const Eigen::Vector3d& p_to);

 private:
  class Graph;

  void straighten(std::vector<Eigen::Vector3d>& path);
  bool is_outside(const Eigen::Vector3d& p_W);
  bool is_free(const Eigen::Vector3d& p_from, const Eigen::Vector3d& p_to);

  const render::TriangleMesh& mesh_;
  SurfaceProbe& probe_;
  std::unique_ptr<Graph> graph_;  // Created on first use.
  Eigen::AlignedBox3d box_;       // Bounding box of the mesh with a margin, m.
  double size_ = 0;               // Diagonal of the mesh's bounding box, m.
};

}  // namespace thimble::scene
