#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "compact_mesh/packed_surface.h"
#include "compact_mesh/sse2.h"

namespace thimble::render {

/// Walks over packed triangles, seen along one direction, to the one in front of a point. Both
/// sides of an edge compute its side from the same numbers in swapped order, so rounding cannot
/// send the walk back and forth. Single precision: its end is a good guess. Real-time: safe; about
/// 45 instructions per packed triangle.
class PackedWalk {
 public:
  /// Takes the point, in steps of the lattice, and the direction.
  PackedWalk(const Eigen::Vector3d& p, const Eigen::Vector3d& n) noexcept
      : px_(rounded(p.x())),
        py_(rounded(p.y())),
        pz_(rounded(p.z())),
        nx_(_mm_set1_ps(static_cast<float>(n.x()))),
        ny_(_mm_set1_ps(static_cast<float>(n.y()))),
        nz_(_mm_set1_ps(static_cast<float>(n.z()))) {}

  /// Returns the edge that the point is farthest outside of; -1 if it is inside of all edges that
  /// are not creases.
  int edge_to_hop(const PackedTriangle& r) const noexcept {
    const __m128 x = relative(r.x.data(), px_);
    const __m128 y = relative(r.y.data(), py_);
    const __m128 z = relative(r.z.data(), pz_);
    const __m128 side =
        _mm_add_ps(_mm_add_ps(_mm_mul_ps(nx_, cross_part(y, z)), _mm_mul_ps(ny_, cross_part(z, x))),
                   _mm_mul_ps(nz_, cross_part(x, y)));
    auto outside = static_cast<std::uint32_t>(_mm_movemask_ps(side)) & 7u & ~r.flags;
    if (outside == 0) return -1;
    auto worst = static_cast<std::size_t>(std::countr_zero(outside));
    outside &= outside - 1;
    if (outside != 0) {
      alignas(16) std::array<float, 4> sides;
      _mm_store_ps(sides.data(), side);
      for (; outside != 0; outside &= outside - 1) {
        const auto k = static_cast<std::size_t>(std::countr_zero(outside));
        if (sides[k] < sides[worst]) worst = k;
      }
    }
    return static_cast<int>(worst);
  }

 private:
  static __m128i rounded(double u) noexcept {
    return _mm_set1_epi32(
        static_cast<std::int32_t>(std::clamp(u, 1 - kLatticeHalf, kLatticeHalf - 1)));
  }
  // Differences to a lattice point; exact before they become floats.
  static __m128 relative(const std::int32_t* v, __m128i p) noexcept {
    const __m128i corners = _mm_loadu_si128(reinterpret_cast<const __m128i*>(v));
    return _mm_cvtepi32_ps(_mm_sub_epi32(corners, p));
  }
  static __m128 next_corner(__m128 v) noexcept {
    return _mm_shuffle_ps(v, v, _MM_SHUFFLE(3, 0, 2, 1));
  }
  static __m128 cross_part(__m128 a, __m128 b) noexcept {
    return _mm_sub_ps(_mm_mul_ps(a, next_corner(b)), _mm_mul_ps(b, next_corner(a)));
  }

  __m128i px_, py_, pz_;
  __m128 nx_, ny_, nz_;
};

}  // namespace thimble::render
