#pragma once

namespace thimble::render {

/// Weight of each triangle in the normal of a vertex.
enum class NormalWeights {
  /// Angle of the triangle at the vertex [Thuermer]: independent of how flat areas are divided.
  kAngle,
  /// sin(angle) / (product of its two sides) [Max]: exact on every mesh of a sphere, and closer
  /// than kAngle on other smooth surfaces; more sensitive to noise in scans.
  kRound,
  /// Normal of the best-fitting paraboloid through the neighbouring vertices [Cazals]: second order
  /// on triangles of any shape, while both weighted means are first order.
  kFitted,
};

}  // namespace thimble::render
