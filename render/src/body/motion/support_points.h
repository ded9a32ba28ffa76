#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Returns up to `most` of a mesh's vertices as its support points. These are the corners of its
/// hull that are farthest apart, beginning with the one farthest from the middle. For a box or any
/// other hull with few corners these are all corners; for a round hull a representative set. m in
/// W, as given. Real-time: never from the servo thread.
std::vector<Eigen::Vector3d> support_points(const TriangleMesh& mesh, std::size_t most);

}  // namespace thimble::render
