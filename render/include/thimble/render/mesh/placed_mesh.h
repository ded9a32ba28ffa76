#pragma once

#include <Eigen/Core>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Places a mesh from its own frame O in the world W: p_WV = R_WO * (scale * p_OV) + p_WO for each
/// vertex V. `scale` turns the file's unit into m and must be finite and not 0; `R_WO` is a
/// rotation; `p_WO` is in m. A negative scale mirrors the mesh, so triangles are turned round to
/// keep their outer side outside. Real-time: never from the servo thread.
TriangleMesh placed(const TriangleMesh& mesh, double scale, const Eigen::Matrix3d& R_WO,
                    const Eigen::Vector3d& p_WO);

}  // namespace thimble::render
