#pragma once

namespace thimble::render {

/// Function by which the normal turns within a band, from the edge of a triangle to its interior. t
/// is the distance from the edge divided by the width of the band.
enum class BlendProfile {
  /// Weight t. The turning rate of the normal jumps where a band begins, ends or meets another band
  /// [BP Fig. 5].
  kLinear,
  /// Weight 3 t^2 - 2 t^3. The turning rate is continuous except at creases, and at most 1.5 times
  /// that of kLinear.
  kSmooth,
};

}  // namespace thimble::render
