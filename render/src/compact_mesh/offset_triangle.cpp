#include "compact_mesh/offset_triangle.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "compact_mesh/unpack_triangle.h"
#include "mesh/triangle_place.h"

namespace thimble::render {

using namespace unpacked;

// All is computed for two or three vectors at once; (a, b) is a pair of them.
inline void OffsetTriangle::unpack_here(const PackedTriangle& r) noexcept {
  creases_ = r.flags & 7u;
  source_ = r.source();
  // Corner 0 twice, and the two sides from it; differences may need 33 bits.
  const Sides x(r.x.data()), y(r.y.data()), z(r.z.data());
  const double area_x = cross_xy(y.both, z.both);
  const double area_y = cross_xy(z.both, x.both);
  const double area_z = cross_xy(x.both, y.both);
  const double per_size = 1 / std::sqrt(area_x * area_x + area_y * area_y + area_z * area_z);
  const double face_x = area_x * per_size, face_y = area_y * per_size, face_z = area_z * per_size;
  // The duals are side_2 x face / size and face x side_1 / size.
  const __m128d scale = _mm_set_pd(-per_size, per_size);
  const auto dual = [scale](__m128d u, double face_v, __m128d v, double face_u) noexcept {
    const __m128d across = _mm_sub_pd(_mm_mul_pd(swapped(u), _mm_set1_pd(face_v)),
                                      _mm_mul_pd(swapped(v), _mm_set1_pd(face_u)));
    return _mm_mul_pd(across, scale);
  };
  const __m128d dual_x = dual(y.both, face_z, z.both, face_y);
  const __m128d dual_y = dual(z.both, face_x, x.both, face_z);
  const __m128d dual_z = dual(x.both, face_y, y.both, face_x);
  _mm_store_pd(ab_[0].data(), dual_x);
  _mm_store_pd(ab_[1].data(), dual_y);
  _mm_store_pd(ab_[2].data(), dual_z);
  const __m128d at_corner =
      _mm_add_pd(_mm_add_pd(_mm_mul_pd(dual_x, x.corner), _mm_mul_pd(dual_y, y.corner)),
                 _mm_mul_pd(dual_z, z.corner));
  _mm_store_pd(ab_[3].data(), _mm_sub_pd(_mm_setzero_pd(), at_corner));
  h_ = {-face_x, -face_y, -face_z,
        face_x * _mm_cvtsd_f64(x.corner) + face_y * _mm_cvtsd_f64(y.corner) +
            face_z * _mm_cvtsd_f64(z.corner)};

  const Vectors n = unpack_normals(r);
  const __m128 dual_xf = _mm_cvtpd_ps(dual_x), dual_yf = _mm_cvtpd_ps(dual_y),
               dual_zf = _mm_cvtpd_ps(dual_z);
  const __m128 u = dot(all<0>(dual_xf), all<0>(dual_yf), all<0>(dual_zf), n);
  const __m128 v = dot(all<1>(dual_xf), all<1>(dual_yf), all<1>(dual_zf), n);
  const auto single = [](double a) noexcept { return _mm_set1_ps(static_cast<float>(a)); };
  const __m128 w = dot(single(face_x), single(face_y), single(face_z), n);
  const __m128 du = _mm_sub_ps(u, all<0>(u)), dv = _mm_sub_ps(v, all<0>(v));
  _mm_store_pd(uv_.data(), _mm_cvtps_pd(_mm_unpacklo_ps(u, v)));
  // (Du_1, Dv_2) and (Du_2, Dv_1).
  const __m128 duv = _mm_shuffle_ps(du, dv, _MM_SHUFFLE(1, 2, 2, 1));
  const __m128 crossed = _mm_shuffle_ps(duv, duv, _MM_SHUFFLE(3, 1, 2, 0));
  _mm_store_pd(along_.data(), _mm_cvtps_pd(crossed));
  _mm_store_pd(across_.data(), _mm_cvtps_pd(_mm_movehl_ps(crossed, crossed)));
  // Differences of numbers near 1 are exact in single precision.
  const __m128 dw = _mm_sub_ps(w, all<0>(w));
  _mm_store_pd(dw_.data(), _mm_cvtps_pd(_mm_shuffle_ps(dw, dw, _MM_SHUFFLE(2, 1, 2, 1))));
  w_ = first(w);
  const double least = w_ + std::min(std::min(dw_[0], dw_[1]), 0.0);
  tilt_squared_ = std::max(1 - least * least, 0.0);

  const __m128 dx = _mm_sub_ps(n.x, all<0>(n.x));
  const __m128 dy = _mm_sub_ps(n.y, all<0>(n.y));
  const __m128 dz = _mm_sub_ps(n.z, all<0>(n.z));
  const __m128 low = _mm_unpacklo_ps(dx, dy), high = _mm_unpackhi_ps(dx, dy);
  _mm_store_ps(n_[0].data(), _mm_movelh_ps(_mm_unpacklo_ps(n.x, n.y), n.z));
  _mm_store_ps(n_[1].data(), _mm_shuffle_ps(low, dz, _MM_SHUFFLE(1, 1, 3, 2)));
  _mm_store_ps(n_[2].data(), _mm_shuffle_ps(high, dz, _MM_SHUFFLE(2, 2, 1, 0)));
  const __m128 bulge = bulges(x, y, z, n);
  bulge_ = {first(bulge), first(all<1>(bulge)), first(all<2>(bulge))};
}

void OffsetTriangle::unpack(const PackedTriangle& r) noexcept {
  if (wide_lanes()) {
    unpack_wide(r);
  } else {
    unpack_plain(r);
  }
}

void OffsetTriangle::unpack_plain(const PackedTriangle& r) noexcept {
  unpack_here(r);
}

void OffsetTriangle::unpack_wide(const PackedTriangle& r) noexcept {
  unpack_here(r);
}

// Continues where one round is not enough: the most bent triangles without creases take four.
OffsetPlace OffsetTriangle::locate_far(__m128d ab, double h, double d) const noexcept {
  constexpr int kRoundsMax = 5;
  OffsetPlace place;
  for (int round = 0; round < kRoundsMax; ++round) {
    place = solve(ab, h, d);
    const double change = place.depth - d;
    d = place.depth;
    if (!place.valid || change * change * tilt_squared_ <= kPlaced * kPlaced) break;
  }
  return place;
}

PathToSurface OffsetTriangle::path_to_surface(const OffsetPlace& place) const noexcept {
  using Eigen::Vector3d;
  // Each is a coordinate along one side or the normal; the sides are their dual basis.
  Eigen::Matrix3d along;
  for (std::size_t i = 0; i < 3; ++i) {
    along.col(static_cast<Eigen::Index>(i)) = Vector3d(ab_[i][0], ab_[i][1], h_[i]);
  }
  const Eigen::Matrix3d sides = along.inverse();
  const auto vector = [](const Lanes& v) {
    return Vector3d(double{v[0]}, double{v[1]}, double{v[2]});
  };
  const Vector3d n_0 = vector(n_[0]);
  const std::array<Vector3d, 3> x{Vector3d::Zero(), sides.col(0), sides.col(1)};
  const std::array<Vector3d, 3> n{n_0, n_0 + vector(n_[1]), n_0 + vector(n_[2])};
  const Vector3d weights = within_triangle({place.l0, place.l1, place.l2});
  const double depth = place.depth;
  const TrianglePlace closest = offset_triangle_place(x, n, weights, depth);
  const Vector3d N = weights[0] * n[0] + weights[1] * n[1] + weights[2] * n[2];
  // As feel_within: the depth is d |N| + bend, bend = rise / (1 + |N|) with rise twice the height.
  const double size = N.norm();
  const Vector3d below_slope = offset_depth_slope(n, closest, depth);
  const Vector3d size_slope =
      closest.change.transpose() * (Vector3d(n[0].dot(N), n[1].dot(N), n[2].dot(N)) / size);
  const double rise = weights[1] * (weights[0] * bulge_[0] + weights[2] * bulge_[1]) +
                      weights[2] * weights[0] * bulge_[2];
  const double bend = rise / (1 + size);
  const Vector3d bend_slope = (2 * height_slope(x, n, closest) - bend * size_slope) / (1 + size);
  const double below = depth * size;
  Vector3d slope = below_slope + bend_slope;
  if (bend < 0 && below >= 0) {
    const ConcaveDepthChange change = change_below_concave(below, -bend);
    slope = change.per_depth * below_slope - change.per_gap * bend_slope;
  }
  return {.to_surface = depth * N,
          .J = x[1] * closest.change.row(1) + x[2] * closest.change.row(2),
          .fall = -slope};
}

}  // namespace thimble::render
