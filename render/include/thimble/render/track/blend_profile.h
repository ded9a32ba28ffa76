#pragma once

namespace thimble::render {

/// How the normal goes over from an edge to the middle of a triangle within a band, t the
/// distance from the edge over the band's width.
enum class BlendProfile {
  kLinear,  ///< By t: its turning rate jumps where a band begins, ends and meets another [BP Fig.
            ///< 5].
  kSmooth,  ///< By 3 t^2 - 2 t^3: its turning rate is continuous everywhere but at creases, and at
            ///< most 1.5 times as large.
};

}  // namespace thimble::render
