#include "thimble/render/contact/compact_contact.h"

#include <emmintrin.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "contact/record_tests.h"
#include "thimble/render/contact/closest_point.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Half a step of the lattice: a tip that is placed better than that is placed as well as the
// corners are.
constexpr double kPlaced = 0.5;

// One round suffices where the triangles are small against their radius; the most bent ones that
// are not creases take four.
constexpr int kRoundsMax = 6;

// Below this the faces lie back to back and the plane between them is rounding (contact_mesh.cpp).
constexpr double kBackToBack = 1e-7;

// How far outside a triangle, as a share of its height, the tip may be and stay: rounding on both
// sides of an edge must not send it back and forth. The jump that this leaves is as small a share
// of the depth.
constexpr double kOutside = -1e-11;

__m128 lanes(const std::int32_t* v) noexcept {
  return _mm_castsi128_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(v)));
}

// Differences to a point on the lattice; exact before they become floats.
__m128 relative(const std::int32_t* v, __m128i p) noexcept {
  return _mm_cvtepi32_ps(_mm_sub_epi32(_mm_castps_si128(lanes(v)), p));
}

__m128 next_corner(__m128 v) noexcept {
  return _mm_shuffle_ps(v, v, _MM_SHUFFLE(3, 0, 2, 1));
}

__m128 cross_part(__m128 a, __m128 b) noexcept {
  return _mm_sub_ps(_mm_mul_ps(a, next_corner(b)), _mm_mul_ps(b, next_corner(a)));
}

// Unpacks the three normals of a record side by side; the same bits give the same normals.
std::array<Vector3d, 3> unpack_normals(const CompactTriangle& r) noexcept {
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
  alignas(16) std::array<float, 4> nx, ny, nz;
  _mm_store_ps(nx.data(), _mm_mul_ps(x, scale));
  _mm_store_ps(ny.data(), _mm_mul_ps(y, scale));
  _mm_store_ps(nz.data(), _mm_mul_ps(z, scale));
  std::array<Vector3d, 3> normals;
  for (std::size_t k = 0; k < 3; ++k) {
    normals[k] = {static_cast<double>(nx[k]), static_cast<double>(ny[k]),
                  static_cast<double>(nz[k])};
  }
  return normals;
}

Vector3d weighted(const std::array<double, 3>& w, const std::array<Vector3d, 3>& v) noexcept {
  return w[0] * v[0] + w[1] * v[1] + w[2] * v[2];
}

// Puts a point outside the triangle on its border: neither direction nor bend are carried beyond
// where they are known.
std::array<double, 3> kept_within(std::array<double, 3> w) noexcept {
  for (double& v : w) v = v > 0 ? v : 0;
  const double sum = w[0] + w[1] + w[2];
  for (double& v : w) v /= sum;
  return w;
}

}  // namespace

CompactContact::CompactContact(CompactSurface surface)
    : surface_(std::make_shared<const CompactSurface>(std::move(surface))),
      search_(std::make_shared<const Bvh>(*surface_)) {}

driver::Result<CompactContact> CompactContact::build(const TriangleMesh& mesh,
                                                     const CompactSurfaceOptions& options) {
  auto surface = CompactSurface::build(mesh, options);
  if (!surface) return surface.error();
  return CompactContact(std::move(surface).value());
}

const ContactState& CompactContact::update(const driver::DeviceState& state) noexcept {
  const Vector3d& p_WT = state.p_WT;
  if (!within_range(p_WT)) {
    state_ = {};
    has_before_ = false;
    return state_;
  }
  if (!state_.touching) {
    Entry entry;
    if (has_before_) entry = search_->first_entry(p_WT_before_, p_WT);
    p_WT_before_ = p_WT;
    has_before_ = true;
    if (entry.triangle < 0) {
      state_ = {};
      return state_;
    }
    unpack(entry.triangle);
    state_.n_W = facet_.face;
  }
  p_WT_before_ = p_WT;
  if (!follow(p_WT, surface_->to_lattice(p_WT))) {
    const std::uint16_t hops = state_.hops;
    state_ = {};
    state_.hops = hops;
  }
  return state_;
}

// Solves p = sum l_i (x_i - d n_i). In the facet's own axes that is a pair of linear equations for
// the weights once d is known, and d = h / sum l_i w_i, where the w_i are nearly 1. It starts from
// the plane of the triangle, not from the last tick, so that the answer depends on the tip and the
// triangle alone.
inline CompactContact::Place CompactContact::locate(const Vector3d& p) const noexcept {
  Place place;
  const Facet& f = facet_;
  const Vector3d to = p - f.corner;
  const double a = f.dual_1.dot(to), b = f.dual_2.dot(to), h = -f.face.dot(to);
  // h / w without a division, good to (1 - w)^2: on fine meshes one round is enough then.
  double d = h * (2 - (f.w[0] + a * f.w[1] + b * f.w[2]));
  for (int round = 0; round < kRoundsMax; ++round) {
    const double m11 = 1 - d * f.u[1], m12 = d * f.u[2], m21 = d * f.v[1], m22 = 1 - d * f.v[2];
    const double r1 = a + d * f.u[0], r2 = b + d * f.v[0];
    const double area = m11 * m22 - m12 * m21;
    if (!(area > 0)) return place;
    const double per_area = 1 / area;
    place.l1 = (r1 * m22 + m12 * r2) * per_area;
    place.l2 = (r2 * m11 + m21 * r1) * per_area;
    const double upright = f.w[0] + place.l1 * f.w[1] + place.l2 * f.w[2];
    if (!(upright > 0)) return place;
    const double change = h / upright - d;
    d += change;
    if (change * change * f.tilt_squared <= kPlaced * kPlaced) break;
  }
  place.l0 = 1 - place.l1 - place.l2;
  place.depth = d;
  place.valid = std::isfinite(d);
  return place;
}

// Tells whether the active triangle holds the tip.
inline bool CompactContact::holds(const Vector3d& p, const Place& place) const noexcept {
  if (facet_.creases != 0) return place.valid && edge_to_hop(p, place) < 0;
  return place.valid && place.l0 >= kOutside && place.l1 >= kOutside && place.l2 >= kOutside;
}

// Fills in the state from a place in the lowered triangle.
inline void CompactContact::report(const Vector3d& p_WT, const Place& place) noexcept {
  const Facet& f = facet_;
  double l0 = place.l0, l1 = place.l1, l2 = place.l2;
  if (l0 < 0 || l1 < 0 || l2 < 0) {
    const auto within = kept_within({l0, l1, l2});
    l0 = within[0];
    l1 = within[1];
    l2 = within[2];
  }
  const Vector3d normal = l0 * f.normals[0] + l1 * f.normals[1] + l2 * f.normals[2];
  const double size = std::sqrt(normal.squaredNorm());
  // Divided by 1 + size in place of 2 it is exact on a sphere, however coarse.
  const double bend =
      (l1 * (f.rise_1 - f.side_1.dot(normal)) + l2 * (f.rise_2 - f.side_2.dot(normal))) /
      (1 + size);
  const double depth = surface_->step() * (place.depth * size + bend);
  const Vector3d n_W = normal * (1 / size);
  state_.touching = true;
  state_.triangle = f.triangle;
  state_.n_W = n_W;
  state_.depth = depth;
  state_.p_WP = p_WT + depth * n_W;
}

bool CompactContact::follow(const Vector3d& p_WT, const Vector3d& p) noexcept {
  const std::int32_t before = facet_.triangle;
  const bool sliding = state_.hops > 0;
  state_.hops = 0;
  // Who hopped in the last tick will hop again: the cheap walk first spares unpacking a triangle
  // that is left at once.
  if (sliding) {
    const std::int32_t next = walk(before, p, state_.hops);
    if (next != before) unpack(next);
  }
  Place place = locate(p);
  bool settled = holds(p, place);
  if (!settled) settled = settle(p, sliding, place);
  if (settled && place.depth >= 0) {
    report(p_WT, place);
    if (state_.depth >= 0) return true;
  }
  if (!search_->inside(p_WT)) {
    // A bulge reaches beyond its triangles.
    if (!settled || place.depth >= 0) return false;
    report(p_WT, place);
    return state_.depth >= 0;
  }
  if (settled && place.depth >= 0) {
    // In a hollow, between the triangles and the surface that they stand for.
    state_.depth = 0;
    state_.p_WP = p_WT;
    return true;
  }
  if (!find_again(p, before)) return false;
  report_nearest(p_WT, p);
  return true;
}

// Hops from triangle to triangle until one holds the tip. `place` becomes its place there. False if
// none does.
bool CompactContact::settle(const Vector3d& p, bool walked, Place& place) noexcept {
  std::array<std::int32_t, 8> visited;
  std::size_t visits = 0;
  while (state_.hops < kHopsMax && visits < visited.size()) {
    const int edge = place.valid ? edge_to_hop(p, place) : -1;
    if (edge < 0) return place.valid;
    visited[visits++] = facet_.triangle;
    const auto end = visited.begin() + static_cast<std::ptrdiff_t>(visits);
    const auto is_new = [&](std::int32_t t) { return std::find(visited.begin(), end, t) == end; };
    std::int32_t next =
        surface_->record(facet_.triangle).neighbours[static_cast<std::size_t>(edge)];
    ++state_.hops;
    if (!is_new(next)) {
      // A gap between lowered triangles: around it all are nearly right.
      ++counters_.cycles;
      return true;
    }
    if (!walked) {
      const std::int32_t far = walk(next, p, state_.hops);
      if (is_new(far)) next = far;
      walked = true;
    }
    unpack(next);
    place = locate(p);
  }
  ++counters_.long_walks;
  return holds(p, place);
}

// Unpacks a record and makes it active.
void CompactContact::unpack(std::int32_t triangle) noexcept {
  const CompactTriangle& r = surface_->record(triangle);
  Facet& f = facet_;
  f.triangle = triangle;
  f.creases = r.flags & 7u;
  f.normals = unpack_normals(r);
  f.corner = r.corner(0);
  f.side_1 = r.corner(1) - f.corner;
  f.side_2 = r.corner(2) - f.corner;
  const Vector3d area = f.side_1.cross(f.side_2);
  const double squared = area.squaredNorm();
  const double per_squared = 1 / squared;
  f.face = area * (1 / std::sqrt(squared));
  f.dual_1 = f.side_2.cross(area) * per_squared;
  f.dual_2 = area.cross(f.side_1) * per_squared;
  const auto& n = f.normals;
  const auto along = [&n](const Vector3d& axis) noexcept -> std::array<double, 3> {
    const double first = axis.dot(n[0]);
    return {first, axis.dot(n[1]) - first, axis.dot(n[2]) - first};
  };
  f.u = along(f.dual_1);
  f.v = along(f.dual_2);
  f.w = along(f.face);
  f.rise_1 = f.side_1.dot(n[1]);
  f.rise_2 = f.side_2.dot(n[2]);
  const double least = f.w[0] + std::min({0.0, f.w[1], f.w[2]});
  f.tilt_squared = std::max(1 - least * least, 0.0);
}

// Tells the edge that the tip is farthest outside of, as a share of the triangle's height; -1 if
// the triangle holds it.
int CompactContact::edge_to_hop(const Vector3d& p, const Place& place) const noexcept {
  std::array<double, 3> side{place.l2, place.l0, place.l1};
  if (facet_.creases != 0) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (((facet_.creases >> k) & 1u) != 0) side[k] = side_of_crease(p, k);
    }
  }
  int worst = 0;
  if (side[1] < side[0]) worst = 1;
  if (side[2] < side[static_cast<std::size_t>(worst)]) worst = 2;
  return side[static_cast<std::size_t>(worst)] < kOutside ? worst : -1;
}

// Tells how far the tip is on this side of the plane that halves the angle at a crease, as a share
// of the triangle's height over that edge.
double CompactContact::side_of_crease(const Vector3d& p, std::size_t edge) const noexcept {
  const CompactTriangle& other =
      surface_->record(surface_->record(facet_.triangle).neighbours[edge]);
  const Vector3d o0 = other.corner(0);
  const Vector3d other_area = (other.corner(1) - o0).cross(other.corner(2) - o0);
  const Vector3d average = facet_.face + other_area / std::sqrt(other_area.squaredNorm());
  const double size = average.norm();
  if (!(size > kBackToBack)) return 0;
  const CompactTriangle& own = surface_->record(facet_.triangle);
  const Vector3d begin = own.corner(edge);
  const Vector3d along = own.corner((edge + 1) % 3) - begin;
  const double twice_area = facet_.side_1.cross(facet_.side_2).norm();
  return average.cross(along).dot(p - begin) / (size * twice_area);
}

// Walks over the triangles as they lie, seen along the last tick's normal, to the one in front of
// the tip; stops at creases. Both sides of an edge compute its side from the same numbers in
// swapped order, so that no rounding sends the walk back and forth.
std::int32_t CompactContact::walk(std::int32_t triangle, const Vector3d& p,
                                  std::uint16_t& hops) const noexcept {
  const auto rounded = [](double u) noexcept {
    return _mm_set1_epi32(
        static_cast<std::int32_t>(std::clamp(u, 1 - kLatticeHalf, kLatticeHalf - 1)));
  };
  const __m128i px = rounded(p.x()), py = rounded(p.y()), pz = rounded(p.z());
  const __m128 nx = _mm_set1_ps(static_cast<float>(state_.n_W.x()));
  const __m128 ny = _mm_set1_ps(static_cast<float>(state_.n_W.y()));
  const __m128 nz = _mm_set1_ps(static_cast<float>(state_.n_W.z()));
  for (; hops < kHopsMax; ++hops) {
    const CompactTriangle& r = surface_->record(triangle);
    const __m128 x = relative(r.x.data(), px);
    const __m128 y = relative(r.y.data(), py);
    const __m128 z = relative(r.z.data(), pz);
    const __m128 side =
        _mm_add_ps(_mm_add_ps(_mm_mul_ps(nx, cross_part(y, z)), _mm_mul_ps(ny, cross_part(z, x))),
                   _mm_mul_ps(nz, cross_part(x, y)));
    auto outside = static_cast<std::uint32_t>(_mm_movemask_ps(side)) & 7u & ~r.flags;
    if (outside == 0) return triangle;
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
    triangle = r.neighbours[worst];
  }
  return triangle;
}

// Looks over the surface around where the walk ended and where it began for the nearest triangle
// that has the tip below it.
bool CompactContact::find_near(const Vector3d& p, std::int32_t before) noexcept {
  std::array<std::int32_t, kPatchMax> patch;
  std::int32_t size = 0;
  const auto add = [&patch, &size](std::int32_t triangle) noexcept {
    const auto end = patch.begin() + size;
    if (size < kPatchMax && std::find(patch.begin(), end, triangle) == end) {
      patch[static_cast<std::size_t>(size++)] = triangle;
    }
  };
  add(facet_.triangle);
  add(before);
  std::int32_t best = -1;
  double best_squared = std::numeric_limits<double>::infinity();
  double best_depth = 0;
  for (std::int32_t i = 0; i < size; ++i) {
    const std::int32_t t = patch[static_cast<std::size_t>(i)];
    const CompactTriangle& r = surface_->record(t);
    const Vector3d a = r.corner(0), b = r.corner(1), c = r.corner(2);
    const Vector3d area = (b - a).cross(c - a);
    const double depth = area.dot(a - p) / std::sqrt(area.squaredNorm());
    for (const std::int32_t neighbour : r.neighbours) add(neighbour);
    if (!(depth >= -kPlaced)) continue;
    const double squared = (closest_point(p, a, b, c) - p).squaredNorm();
    if (squared < best_squared || (squared == best_squared && depth > best_depth)) {
      best = t;
      best_squared = squared;
      best_depth = depth;
    }
  }
  if (best < 0) return false;
  unpack(best);
  return true;
}

bool CompactContact::find_again(const Vector3d& p, std::int32_t before) noexcept {
  if (find_near(p, before)) {
    ++counters_.found_near;
    return true;
  }
  const Vector3d p_W = surface_->origin() + surface_->step() * p;
  const SurfacePoint nearest = search_->closest(p_W, std::numeric_limits<double>::infinity());
  if (nearest.triangle < 0) return false;
  ++counters_.found_far;
  unpack(nearest.triangle);
  return true;
}

// Fills in the state from the nearest point of the active triangle, where no lowered triangle
// holds the tip.
void CompactContact::report_nearest(const Vector3d& p_WT, const Vector3d& p) noexcept {
  const Vector3d& a = facet_.corner;
  const Vector3d q = closest_point(p, a, a + facet_.side_1, a + facet_.side_2);
  const double v = facet_.dual_1.dot(q - a);
  const double w = facet_.dual_2.dot(q - a);
  const auto within = kept_within({1 - v - w, v, w});
  const Vector3d normal = weighted(within, facet_.normals);
  state_.touching = true;
  state_.triangle = facet_.triangle;
  state_.n_W = normal / std::sqrt(normal.squaredNorm());
  state_.depth = surface_->step() * std::max((q - p).dot(state_.n_W), 0.0);
  state_.p_WP = p_WT + state_.depth * state_.n_W;
}

}  // namespace thimble::render
