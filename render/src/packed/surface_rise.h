#pragma once

#include <span>

#include "packed/compact_surface.h"

namespace thimble::render {

/// Finds how far the surface rises above some records at most, in steps; 0 where that is less than
/// 1e-5 of the size of the lattice and nobody would feel it. Real-time: safe; some ns each.
double rise_above(std::span<const CompactTriangle> records) noexcept;

}  // namespace thimble::render
