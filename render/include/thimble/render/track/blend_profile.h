#pragma once

namespace thimble::render {

/// Transition of the normal from an edge to the interior of a triangle within a band. t is the
/// distance from the edge divided by the width of the band.
enum class BlendProfile {
  /// Weight t: the turning rate of the normal jumps where a band begins, ends and meets another [BP
  /// Fig. 5].
  kLinear,
  /// Weight 3 t^2 - 2 t^3: the turning rate is continuous except at creases, and at most 1.5 times
  /// as large.
  kSmooth,
};

}  // namespace thimble::render
