#pragma once

// Vectors of 16 bytes by the names of SSE2: of the processor itself on x86-64, of SIMDe elsewhere.
// Both give bit-identical results for the functions in use (sse2_test, which tests/arm64.sh also
// runs), except for what the test names.
#if defined(__x86_64__)
#include <emmintrin.h>
#else
#define SIMDE_ENABLE_NATIVE_ALIASES
#include <simde/x86/sse2.h>
#endif
