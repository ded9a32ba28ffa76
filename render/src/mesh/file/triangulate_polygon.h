#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Appends the triangles of a polygon, wound like it. A convex polygon becomes a fan from its first
/// corner; another one is cut ear by ear, seen along its mean normal. A polygon that crosses itself
/// still gives size - 2 triangles. Returns false, and appends nothing, for a concave polygon with
/// more than 2,000 corners, which would take minutes. Precondition: `corners` has at least 3
/// numbers of existing vertices. Real-time: never from the servo thread.
[[nodiscard]] bool triangulate_polygon(const std::vector<Eigen::Vector3d>& vertices,
                                       std::span<const std::int32_t> corners,
                                       std::vector<std::array<std::int32_t, 3>>& triangles);

/// Returns the error about a polygon that `triangulate_polygon` refuses ("face 7 is concave ...").
std::string too_many_corners(const std::string& face, std::size_t corners);

}  // namespace thimble::render
