#pragma once

#include <span>

#include "compact_mesh/packed_surface.h"

namespace thimble::render {

/// Returns the maximum height of the smooth surface above some packed triangles, in steps; 0 if it
/// is less than 1e-5 of the size of the lattice and cannot be felt. Real-time: safe; some ns each.
double rise_above(std::span<const PackedTriangle> triangles) noexcept;

}  // namespace thimble::render
