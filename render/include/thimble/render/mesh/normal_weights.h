#pragma once

namespace thimble::render {

/// How much each face counts in the normal of a vertex.
enum class NormalWeights {
  kAngle,   ///< By its angle there [Thuermer]: flat ground may be cut up at will.
  kRound,   ///< By sin(angle) / (product of its two sides) [Max]: exact on every mesh of a sphere,
            ///< and closer than kAngle on other smooth surfaces; noisy scans sway it more.
  kFitted,  ///< Of the paraboloid that fits the vertices around best [Cazals]: second
            ///< order on triangles of any shape, where both means are first order.
};

}  // namespace thimble::render
