#pragma once

#include "thimble/driver/export.h"

namespace thimble::render {

/// Marks a function, with all that it calls, as made for AVX2: what it computes is the same to the
/// bit, in fewer instructions. Call it only where `wide_lanes` says so.
#if defined(__x86_64__)
#define THIMBLE_FOR_AVX2 [[gnu::flatten, gnu::target("avx2")]]
#else
#define THIMBLE_FOR_AVX2
#endif

/// Returns whether this processor computes with eight single or four double numbers at a time
/// (AVX2) and the compiler made code for it; THIMBLE_PLAIN_LANES in the environment says no, to
/// compare. Answers are the same to the bit: no operation is fused, and lanes never mix. Real-time:
/// safe after the first call.
THIMBLE_EXPORT bool wide_lanes() noexcept;

}  // namespace thimble::render
