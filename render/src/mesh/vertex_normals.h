#pragma once

#include <Eigen/Core>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Returns the angle (rad, 0 to pi) between two sides that leave a corner, exact for slivers too. 0
/// if a side has no length. Real-time: safe.
THIMBLE_EXPORT double corner_angle(const Eigen::Vector3d& to_next,
                                   const Eigen::Vector3d& to_last) noexcept;

/// Returns unit normals at the vertices, in the mesh's frame: triangle normals weighted by the
/// triangle's angle there [Thuermer]. So the result does not depend on how a surface is divided.
/// Zero for a vertex without triangle. Precondition: triangles name existing vertices. Real-time:
/// never from the servo thread.
THIMBLE_EXPORT std::vector<Eigen::Vector3d> vertex_normals(const TriangleMesh& mesh);

}  // namespace thimble::render
