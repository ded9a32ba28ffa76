#pragma once

#include <emmintrin.h>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "contact/near_list.h"
#include "contact/nearest_so_far.h"
#include "contact/node_stack.h"
#include "contact/record_tests.h"
#include "thimble/render/contact/box_node.h"
#include "thimble/render/contact/compact_surface.h"
#include "thimble/render/contact/contact_mesh.h"
#include "thimble/render/contact/search_frame.h"
#include "thimble/render/contact/tree_nodes.h"
#include "thimble/render/contact/volume_grid.h"

// The same code for every processor, in lanes_plain, and for those with AVX2, in lanes_avx2
// (lanes.inc). wide_lanes says which to call. Attributes stand at each function, not at a file, so
// that no code of the library's own headers is ever made for AVX2 alone.

#define THIMBLE_LANES_NAMESPACE lanes_plain
#define THIMBLE_LANES_AVX2 0
#define THIMBLE_LANES [[gnu::always_inline]] inline
#define THIMBLE_LANES_FAR inline
#include "contact/lanes.inc"
#include "contact/tree_lanes.inc"

#include "contact/segment_lanes.inc"

#include "contact/nearest_lanes.inc"
#undef THIMBLE_LANES_NAMESPACE
#undef THIMBLE_LANES_AVX2
#undef THIMBLE_LANES
#undef THIMBLE_LANES_FAR

#if defined(__x86_64__)
#define THIMBLE_LANES_NAMESPACE lanes_avx2
#define THIMBLE_LANES_AVX2 1
#define THIMBLE_LANES [[gnu::always_inline, gnu::target("avx2")]] inline
#define THIMBLE_LANES_FAR [[gnu::target("avx2")]] inline
#include "contact/lanes.inc"
#include "contact/tree_lanes.inc"

#include "contact/segment_lanes.inc"

#include "contact/nearest_lanes.inc"
#undef THIMBLE_LANES_NAMESPACE
#undef THIMBLE_LANES_AVX2
#undef THIMBLE_LANES
#undef THIMBLE_LANES_FAR
#else
namespace thimble::render {
namespace lanes_avx2 = lanes_plain;
}
#endif
