#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Cuts a closed mesh into at most `most` parts whose convex hulls together enclose little more
/// than the mesh; returns the points of each hull, m. A cut is a plane across the part with the
/// largest gain: the volume by which the hulls of both halves are smaller than that of the part.
/// If no cut gains 1 % of the mesh's hull, the largest part is halved. Ends early when the hulls
/// enclose at most 1 % too much. The halves' hulls overlap in the plane at most.
/// Real-time: never from the servo thread.
std::vector<std::vector<Eigen::Vector3d>> convex_pieces(const TriangleMesh& mesh, std::size_t most);

}  // namespace thimble::render
