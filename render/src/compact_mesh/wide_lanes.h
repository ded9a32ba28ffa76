#pragma once

#include "thimble/driver/export.h"

namespace thimble::render {

/// Marks a function, with all that it calls, as compiled for AVX2. Its results are bit-identical,
/// with fewer instructions. Call it only if `wide_lanes` returns true.
#if defined(__x86_64__)
#define THIMBLE_FOR_AVX2 [[gnu::flatten, gnu::target("avx2")]]
#else
#define THIMBLE_FOR_AVX2
#endif

/// Returns whether this processor computes with eight single or four double numbers at a time
/// (AVX2) and the compiler made code for it. THIMBLE_PLAIN_LANES in the environment makes it false,
/// for comparison. Results are bit-identical: no operation is fused, and lanes never mix.
/// Real-time: safe after the first call.
THIMBLE_EXPORT bool wide_lanes() noexcept;

}  // namespace thimble::render
