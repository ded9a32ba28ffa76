#include "thimble/render/contact/lowered_triangle.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "thimble/render/contact/closest_point.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Below this the faces lie back to back and the plane between them is rounding (contact_mesh.cpp).
constexpr double kBackToBack = 1e-7;

// Three vectors side by side, one per lane; the fourth lane is any finite number.
struct Vectors {
  __m128 x, y, z;
};

template <unsigned kLane>
__m128 all(__m128 v) noexcept {
  return _mm_shuffle_ps(v, v, _MM_SHUFFLE(kLane, kLane, kLane, kLane));
}

double first(__m128 v) noexcept {
  return static_cast<double>(_mm_cvtss_f32(v));
}

__m128d swapped(__m128d v) noexcept {
  return _mm_shuffle_pd(v, v, 1);
}

// u_1 v_2 - u_2 v_1 of two pairs.
double x_times_y(__m128d u, __m128d v) noexcept {
  const __m128d products = _mm_mul_pd(u, swapped(v));
  return _mm_cvtsd_f64(_mm_sub_sd(products, _mm_unpackhi_pd(products, products)));
}

// One coordinate of corner 0, twice, and of the two sides from it.
struct Sides {
  explicit Sides(const std::int32_t* v) noexcept {
    const __m128i corners = _mm_loadu_si128(reinterpret_cast<const __m128i*>(v));
    corner = _mm_cvtepi32_pd(_mm_shuffle_epi32(corners, 0));
    both = _mm_sub_pd(_mm_cvtepi32_pd(_mm_shuffle_epi32(corners, _MM_SHUFFLE(2, 2, 2, 1))), corner);
  }
  // From each corner to the next; the fourth lane is 0.
  __m128 edges() const noexcept {
    const __m128 sides = _mm_cvtpd_ps(both);  // side 1, side 2, 0, 0
    return _mm_sub_ps(sides, _mm_shuffle_ps(sides, sides, _MM_SHUFFLE(3, 1, 0, 3)));
  }
  __m128d corner, both;
};

// From each corner's to the next one's.
__m128 turn(__m128 v) noexcept {
  return _mm_sub_ps(_mm_shuffle_ps(v, v, _MM_SHUFFLE(3, 0, 2, 1)), v);
}

// Unpacks the three normals of a record; the same bits give the same normals.
Vectors unpack_normals(const CompactTriangle& r) noexcept {
  // The fourth lane is a neighbour's number: any bits are a finite normal.
  const __m128i packed = _mm_loadu_si128(reinterpret_cast<const __m128i*>(r.normals.data()));
  const __m128 sign = _mm_set1_ps(-0.0f);
  __m128 x = _mm_cvtepi32_ps(_mm_srai_epi32(_mm_slli_epi32(packed, 16), 16));
  __m128 y = _mm_cvtepi32_ps(_mm_srai_epi32(packed, 16));
  const __m128 z = _mm_sub_ps(_mm_set1_ps(kOctahedron),
                              _mm_add_ps(_mm_andnot_ps(sign, x), _mm_andnot_ps(sign, y)));
  const __m128 fold = _mm_max_ps(_mm_sub_ps(_mm_setzero_ps(), z), _mm_setzero_ps());
  x = _mm_sub_ps(x, _mm_or_ps(fold, _mm_and_ps(sign, x)));
  y = _mm_sub_ps(y, _mm_or_ps(fold, _mm_and_ps(sign, y)));
  const __m128 squared =
      _mm_add_ps(_mm_add_ps(_mm_mul_ps(x, x), _mm_mul_ps(y, y)), _mm_mul_ps(z, z));
  const __m128 scale = _mm_div_ps(_mm_set1_ps(1), _mm_sqrt_ps(squared));
  return {_mm_mul_ps(x, scale), _mm_mul_ps(y, scale), _mm_mul_ps(z, scale)};
}

__m128 dot(__m128 x, __m128 y, __m128 z, const Vectors& b) noexcept {
  return _mm_add_ps(_mm_add_ps(_mm_mul_ps(x, b.x), _mm_mul_ps(y, b.y)), _mm_mul_ps(z, b.z));
}

// (x_i - x_j) . (n_i - n_j) of the edges 01, 12 and 20.
__m128 bulges(const Sides& x, const Sides& y, const Sides& z, const Vectors& n) noexcept {
  return _mm_add_ps(
      _mm_add_ps(_mm_mul_ps(x.edges(), turn(n.x)), _mm_mul_ps(y.edges(), turn(n.y))),
      _mm_mul_ps(z.edges(), turn(n.z)));
}

Vector3d area_of(const CompactTriangle& r) noexcept {
  const Vector3d corner = r.corner(0);
  return (r.corner(1) - corner).cross(r.corner(2) - corner);
}

}  // namespace

// Everything is made for two or three vectors at once; (a, b) stands for a pair of them.
inline void LoweredTriangle::unpack_here(const CompactTriangle& r) noexcept {
  creases_ = r.flags & 7u;
  source_ = r.source();
  // Corner 0 twice, and the two sides from it; differences may need 33 bits.
  const Sides x(r.x.data()), y(r.y.data()), z(r.z.data());
  const double area_x = x_times_y(y.both, z.both);
  const double area_y = x_times_y(z.both, x.both);
  const double area_z = x_times_y(x.both, y.both);
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
  const __m128 uv_1 = _mm_unpacklo_ps(du, dv);
  _mm_store_pd(uv_[0].data(), _mm_cvtps_pd(_mm_unpacklo_ps(u, v)));
  _mm_store_pd(uv_[1].data(), _mm_cvtps_pd(_mm_movehl_ps(uv_1, uv_1)));
  _mm_store_pd(uv_[2].data(), _mm_cvtps_pd(_mm_unpackhi_ps(du, dv)));
  // Differences of numbers near 1 are exact in single precision.
  const __m128 dw = _mm_sub_ps(w, all<0>(w));
  w_ = {first(w), first(all<1>(dw)), first(all<2>(dw))};
  const double least = w_[0] + std::min(std::min(w_[1], w_[2]), 0.0);
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

void LoweredTriangle::unpack(const CompactTriangle& r) noexcept {
  if (wide_lanes()) {
    unpack_wide(r);
  } else {
    unpack_here(r);
  }
}

void LoweredTriangle::unpack_wide(const CompactTriangle& r) noexcept {
  unpack_here(r);
}

// Goes on where one round does not suffice: the most bent triangles that are no creases take four.
LoweredPlace LoweredTriangle::locate_far(double a, double b, double h, double d) const noexcept {
  constexpr int kRoundsMax = 5;
  LoweredPlace place;
  for (int round = 0; round < kRoundsMax; ++round) {
    place = solve(a, b, h, d);
    const double change = place.depth - d;
    d = place.depth;
    if (!place.valid || change * change * tilt_squared_ <= kPlaced * kPlaced) break;
  }
  return place;
}

double side_of_crease(const Vector3d& p, const CompactTriangle& own, std::size_t edge,
                      const CompactTriangle& other) noexcept {
  const Vector3d area = area_of(own);
  const Vector3d other_area = area_of(other);
  const double twice_area = std::sqrt(area.squaredNorm());
  const Vector3d average = area / twice_area + other_area / std::sqrt(other_area.squaredNorm());
  const double size = average.norm();
  if (!(size > kBackToBack)) return 0;
  const Vector3d begin = own.corner(edge);
  const Vector3d along = own.corner((edge + 1) % 3) - begin;
  return average.cross(along).dot(p - begin) / (size * twice_area);
}

LoweredFeel feel_nearest(const Vector3d& p, const CompactTriangle& r,
                         const LoweredTriangle& lowered) noexcept {
  const Vector3d a = r.corner(0), b = r.corner(1), c = r.corner(2);
  const Vector3d q = closest_point(p, a, b, c);
  const Vector3d area = area_of(r);
  const double per_squared = 1 / area.squaredNorm();
  LoweredPlace place;
  place.l1 = (c - a).cross(area).dot(q - a) * per_squared;
  place.l2 = area.cross(b - a).dot(q - a) * per_squared;
  place.l0 = 1 - place.l1 - place.l2;
  LoweredFeel felt = lowered.feel(place);
  felt.depth = std::max((q - p).dot(felt.n_W), 0.0);
  return felt;
}

double rise_above(std::span<const CompactTriangle> records) noexcept {
  constexpr double kFelt = 1e-5 * 2 * kLatticeHalf;
  // A third of the largest bulge is the most that the sum over pairs reaches, and where corners are
  // not creases 1 + |sum l_i n_i| is above 5/3.
  __m128 most = _mm_setzero_ps();
  for (const CompactTriangle& r : records) {
    const Sides x(r.x.data()), y(r.y.data()), z(r.z.data());
    most = _mm_max_ps(most, bulges(x, y, z, unpack_normals(r)));
  }
  const double rise = std::max(std::max(first(most), first(all<1>(most))), first(all<2>(most))) / 5;
  return rise > kFelt ? rise : 0;
}

}  // namespace thimble::render
