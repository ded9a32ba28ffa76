#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Appends the triangles of a polygon, wound like it. A convex polygon becomes a fan from its first
/// corner; another one is cut ear by ear, seen along its mean normal. A polygon that crosses itself
/// still gives size - 2 triangles. Precondition: `corners` has at least 3 numbers of existing
/// vertices. Real-time: never from the servo thread.
void triangulate_polygon(const std::vector<Eigen::Vector3d>& vertices,
                         std::span<const std::int32_t> corners,
                         std::vector<std::array<std::int32_t, 3>>& triangles);

}  // namespace thimble::render
