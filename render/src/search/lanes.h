#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "compact_mesh/packed_surface.h"
#include "compact_mesh/sse2.h"
#include "mesh/contact_mesh.h"
#include "search/box_node.h"
#include "search/eight_triangles.h"
#include "search/near_list.h"
#include "search/nearest_so_far.h"
#include "search/node_stack.h"
#include "search/search_frame.h"
#include "search/segment_test.h"
#include "search/tree_nodes.h"
#include "search/volume_grid.h"

// The same code for every processor in lanes_plain, and for those with AVX2 in lanes_avx2
// (lanes.inc). wide_lanes decides which to call. Attributes are at each function, not at a file, so
// that no code of the library's own headers is compiled for AVX2 only.

#define THIMBLE_LANES_NAMESPACE lanes_plain
#define THIMBLE_LANES_AVX2 0
#define THIMBLE_LANES [[gnu::always_inline]] inline
#define THIMBLE_LANES_FAR inline
#include "search/lanes.inc"
#include "search/tree_lanes.inc"

#include "search/eight_lanes.inc"
#include "search/segment_lanes.inc"

#include "search/nearest_lanes.inc"
#undef THIMBLE_LANES_NAMESPACE
#undef THIMBLE_LANES_AVX2
#undef THIMBLE_LANES
#undef THIMBLE_LANES_FAR

#if defined(__x86_64__)
#define THIMBLE_LANES_NAMESPACE lanes_avx2
#define THIMBLE_LANES_AVX2 1
#define THIMBLE_LANES [[gnu::always_inline, gnu::target("avx2")]] inline
#define THIMBLE_LANES_FAR [[gnu::target("avx2")]] inline
#include "search/lanes.inc"
#include "search/tree_lanes.inc"

#include "search/eight_lanes.inc"
#include "search/segment_lanes.inc"

#include "search/nearest_lanes.inc"
#undef THIMBLE_LANES_NAMESPACE
#undef THIMBLE_LANES_AVX2
#undef THIMBLE_LANES
#undef THIMBLE_LANES_FAR
#else
namespace thimble::render {
namespace lanes_avx2 = lanes_plain;
}
#endif
