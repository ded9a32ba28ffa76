#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "thimble/render/mesh/check_mesh.h"

namespace thimble::render {

/// Flatter triangles do not close a hole. A hundred times the limit of check_mesh, because a mesh
/// that is moved or scaled is rounded again.
inline constexpr double kFillFlatness = 100 * kFlatness;

/// A hole in a surface as a ring of places. Corner k is joined to corner k + 1 by an edge. The
/// triangle on its other side has the unit normal `beside[k]`, seen from the side from which the
/// ring is counter-clockwise.
struct HoleRing {
  std::vector<Eigen::Vector3d> corners;
  std::vector<Eigen::Vector3d> beside;
};

/// Returns the triangles that close a hole, as numbers of its corners, wound like the ring. Flat
/// holes are cut like a polygon. For others the sharpest bend, also towards the triangles around,
/// is minimised, and then the area (P. Liepa, Filling Holes in Meshes, 2003); large ones are first
/// reduced at their bluntest corners. `taken(i, j)`: whether corners i and j are joined already, so
/// that no triangle may join them again. Empty if no such triangles were found. O(n^2), and at most
/// some 10 ms more. Precondition: at least three corners. Real-time: never from the servo thread.
std::vector<std::array<std::int32_t, 3>> fill_polygon(
    const HoleRing& ring, const std::function<bool(std::int32_t, std::int32_t)>& taken);

}  // namespace thimble::render
