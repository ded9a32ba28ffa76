#pragma once

#include <span>

#include "compact_mesh/packed_surface.h"

namespace thimble::render {

/// Finds how far the surface rises above some packed triangles at most, in steps; 0 where that is
/// less than 1e-5 of the size of the lattice and nobody would feel it. Real-time: safe; some ns
/// each.
double rise_above(std::span<const PackedTriangle> triangles) noexcept;

}  // namespace thimble::render
