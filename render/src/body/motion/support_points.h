#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Chooses up to `most` of a mesh's vertices for it to stand on: the corners of its hull that are
/// farthest apart, beginning with the one farthest from the middle. All corners of a box or any
/// other hull with few of them; of a round hull what stands for it. m in W, as given. Real-time:
/// never from the servo thread.
std::vector<Eigen::Vector3d> support_points(const TriangleMesh& mesh, std::size_t most);

}  // namespace thimble::render
