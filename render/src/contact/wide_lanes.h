#pragma once

namespace thimble::render {

/// Tells whether this processor computes with eight single or four double numbers at a time (AVX2)
/// and the compiler made code for it; THIMBLE_PLAIN_LANES in the environment says no, to compare.
/// Answers are the same to the bit: no operation is fused, and lanes never mix.
/// Real-time: safe after the first call.
bool wide_lanes() noexcept;

}  // namespace thimble::render
