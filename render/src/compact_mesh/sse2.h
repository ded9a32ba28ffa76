#pragma once

// Lanes of 16 bytes: x86-64's own, or the same functions for any other processor.
#if defined(__x86_64__)
#include <emmintrin.h>
#else
#include "compact_mesh/sse2_elsewhere.h"
namespace thimble::render {
using namespace sse2_elsewhere;
}
#endif
