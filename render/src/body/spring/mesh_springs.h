#pragma once

#include <cstdint>
#include <vector>

#include "body/spring/spring_network.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Settings of the springs of a mesh, equal at all vertices and along all edges.
struct MeshSpringSettings {
  double mass = 1e-3;              ///< kg per vertex, > 0
  double base_stiffness = 0;       ///< N/m, vertex to its base point
  double base_damping = 0;         ///< N s/m
  double neighbour_stiffness = 0;  ///< N/m, along each edge
  double neighbour_damping = 0;    ///< N s/m
  /// True: springs pull only along their edges. False: equally in all directions.
  bool directed = false;
};

/// Joins the vertices of a mesh (m) along its edges, each vertex free in three directions. A vertex
/// that no triangle names has only its base spring. The error is that of SpringNetwork::build, or
/// names an edge with no length. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<SpringNetwork<3>> join_vertices(const TriangleMesh& mesh,
                                                              const MeshSpringSettings& settings);

}  // namespace thimble::render
