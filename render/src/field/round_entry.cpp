#include "field/round_entry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace thimble::render::shape_solid {
namespace {

using Eigen::Vector3d;

constexpr double kForever = std::numeric_limits<double>::infinity();

/// Part of a path, in its parameter, that is inside a convex set.
struct Span {
  double in = kForever;  ///< -infinity if the path begins inside.
  double out = -kForever;
  std::int32_t face = -1;
};

/// Returns the part below a plane: height + t * rise < 0.
Span below(double height, double rise, std::int32_t face) noexcept {
  if (height < 0) return {-kForever, rise > 0 ? -height / rise : kForever, face};
  // Written so that NaN misses.
  if (!(rise < 0)) return {};
  return {-height / rise, kForever, face};
}

/// Solutions of a t^2 + 2 b t + c = 0, in ascending order. `always`: they exist, whatever rounding
/// says.
struct Roots {
  std::array<double, 2> t{};
  std::size_t count = 0;
};

Roots roots_of(double a, double b, double c, bool always = false) noexcept {
  Roots roots;
  double root = b * b - a * c;
  if (always && root < 0) root = 0;
  if (!(root >= 0)) return roots;
  // Without cancellation.
  const double q = -(b + std::copysign(std::sqrt(root), b));
  if (a != 0) roots.t[roots.count++] = q / a;
  if (q != 0) roots.t[roots.count++] = c / q;
  if (roots.count == 2 && roots.t[0] > roots.t[1]) std::swap(roots.t[0], roots.t[1]);
  return roots;
}

/// Returns the part inside of an endless cylinder about z.
Span within_cylinder(const Vector3d& from, const Vector3d& way, double radius,
                     std::int32_t face) noexcept {
  const double a = way.x() * way.x() + way.y() * way.y();
  const double b = from.x() * way.x() + from.y() * way.y();
  const double c = from.x() * from.x() + from.y() * from.y() - radius * radius;
  const double root = b * b - a * c;
  if (c < 0) {
    return {-kForever,
            a > 0 ? (b > 0 ? -c / (std::sqrt(root) + b) : (std::sqrt(root) - b) / a) : kForever,
            face};
  }
  if (!(b < 0 && root > 0)) return {};
  return {c / (std::sqrt(root) - b), (std::sqrt(root) - b) / a, face};
}

/// Returns the part inside of an endless cone about z with its tip at the height `tip`, below the
/// tip. `slope` is the tangent of half its angle.
Span within_cone(const Vector3d& from, const Vector3d& way, double slope, double tip,
                 std::int32_t face) noexcept {
  const double below_tip = tip - from.z();
  const double k = slope * slope;
  const double a = way.x() * way.x() + way.y() * way.y() - k * way.z() * way.z();
  const double b = from.x() * way.x() + from.y() * way.y() + k * below_tip * way.z();
  const double c = from.x() * from.x() + from.y() * from.y() - k * below_tip * below_tip;
  Span span{.face = face};
  if (a < 0) {
    // Steeper than the cone: one root is on it, the other on its mirror image above the tip. They
    // exist, whatever rounding says.
    const Roots roots = roots_of(a, b, c, true);
    if (way.z() < 0) {
      span.in = roots.t[1];
      span.out = kForever;
    } else {
      span.in = -kForever;
      span.out = roots.t[0];
    }
  } else {
    const Roots roots = roots_of(a, b, c);
    if (roots.count == 2) {
      const double middle = (roots.t[0] + roots.t[1]) / 2;
      if (!(below_tip - middle * way.z() > 0)) return {};
      span.in = roots.t[0];
      span.out = roots.t[1];
    } else if (roots.count == 1 && b * way.z() > 0) {
      // Along the side. Otherwise it is in the mirror image.
      (way.z() < 0 ? span.in : span.out) = roots.t[0];
      (way.z() < 0 ? span.out : span.in) = way.z() < 0 ? kForever : -kForever;
    } else {
      return {};
    }
  }
  if (c < 0 && below_tip > 0) {
    span.in = -kForever;
    return span;
  }
  // Near the tip both roots are one, of which half of the digits are known. The height over the
  // side is convex along the path.
  for (int step = 0; step < 2 && span.in > -kForever; ++step) {
    const Vector3d p = from + span.in * way;
    const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
    const double fall = (rho > 0 ? (p.x() * way.x() + p.y() * way.y()) / rho : 0) + slope * way.z();
    if (fall < 0) span.in -= (rho - slope * (tip - p.z())) / fall;
  }
  // It begins outside.
  if (span.out > 0) span.in = std::max(span.in, 0.0);
  return span;
}

/// Returns where a path enters all of the spans; the first of two that it enters at once.
template <std::size_t kCount>
SolidEntry into_all(const std::array<Span, kCount>& spans) noexcept {
  Span all{-kForever, kForever, -1};
  for (const Span& span : spans) {
    if (span.in > all.in) {
      all.in = span.in;
      all.face = span.face;
    }
    all.out = std::min(all.out, span.out);
  }
  if (all.face < 0 || !(all.in >= 0 && all.in <= 1 && all.in < all.out)) return {};
  return {.triangle = all.face, .parameter = all.in};
}

/// Returns the entry of a path that rounding has missed although it leads from outside to inside:
/// by the face of which it began farthest outside. `heights` are those of the begin over the faces.
template <std::size_t kCount>
SolidEntry rounded(const std::array<double, kCount>& heights) noexcept {
  const auto highest = std::max_element(heights.begin(), heights.end());
  return {.triangle = static_cast<std::int32_t>(highest - heights.begin()), .parameter = 1};
}

}  // namespace

SolidEntry first_entry(const Cylinder& cylinder, const Vector3d& p_from,
                       const Vector3d& p_to) noexcept {
  const Vector3d from = cylinder.to_shape(p_from), way = cylinder.to_shape(p_to) - from;
  const double h = cylinder.half_height;
  const SolidEntry entry =
      into_all<3>({below(-h - from.z(), -way.z(), 0), below(from.z() - h, way.z(), 1),
                   within_cylinder(from, way, cylinder.radius, Cylinder::kSide)});
  if (entry.triangle >= 0 || cylinder.inside(p_from) || !cylinder.inside(p_to)) return entry;
  return rounded<3>({-h - from.z(), from.z() - h,
                     std::sqrt(from.x() * from.x() + from.y() * from.y()) - cylinder.radius});
}

SolidEntry first_entry(const Cone& cone, const Vector3d& p_from, const Vector3d& p_to) noexcept {
  const Vector3d from = cone.to_shape(p_from), way = cone.to_shape(p_to) - from;
  const double h = cone.half_height;
  const SolidEntry entry =
      into_all<2>({below(-h - from.z(), -way.z(), 0),
                   within_cone(from, way, cone.radius / (2 * h), h, Cone::kSide)});
  if (entry.triangle >= 0 || cone.inside(p_from) || !cone.inside(p_to)) return entry;
  const double across = std::sqrt(from.x() * from.x() + from.y() * from.y()) - cone.radius;
  return rounded<2>({-h - from.z(), cone.cosine() * across + cone.sine() * (from.z() + h)});
}

SolidEntry first_entry(const Capsule& capsule, const Vector3d& p_from,
                       const Vector3d& p_to) noexcept {
  const Vector3d from = capsule.to_shape(p_from), way = capsule.to_shape(p_to) - from;
  const double h = capsule.half_height;
  if (capsule.inside(p_from)) return {};
  double first = kForever;
  // The ends of the cylinder are inside of the balls.
  const Span side = within_cylinder(from, way, capsule.radius, 0);
  if (side.in >= 0 && side.in <= 1 && std::abs(from.z() + side.in * way.z()) <= h) first = side.in;
  for (const double end : {-h, h}) {
    const Vector3d p = from - Vector3d(0, 0, end);
    const double c = p.squaredNorm() - capsule.radius * capsule.radius, b = p.dot(way);
    const double root = b * b - way.squaredNorm() * c;
    if (c >= 0 && b < 0 && root > 0) first = std::min(first, c / (std::sqrt(root) - b));
  }
  if (first <= 1) return {.triangle = 0, .parameter = first};
  if (!capsule.inside(p_to)) return {};
  return {.triangle = 0, .parameter = 1};
}

namespace {

/// Returns the place between `a` and `b` where a continuous function that is not negative at `a`
/// and negative at `b` becomes negative.
template <class Function>
double falls_below(const Function& f, double a, double b) noexcept {
  // Halving ends at two neighbouring numbers.
  for (int i = 0; i < 80; ++i) {
    const double middle = (a + b) / 2;
    if (!(a < middle && middle < b)) break;
    (f(middle) < 0 ? b : a) = middle;
  }
  return a;
}

/// Divides 0 to 1 at the roots of a function that is monotonic between the given places: adds one
/// root for each piece at whose ends the signs differ.
struct Places {
  std::array<double, 6> t{0};
  std::size_t count = 1;
  void add(double place) noexcept {
    if (place > 0 && place < 1) t[count++] = place;
  }
  void end() noexcept { t[count++] = 1; }
};

template <class Function>
Places roots_between(const Function& f, const Places& pieces) noexcept {
  Places roots;
  for (std::size_t i = 0; i + 1 < pieces.count; ++i) {
    const double a = pieces.t[i], b = pieces.t[i + 1];
    const double at_a = f(a), at_b = f(b);
    if (at_a >= 0 && at_b < 0) roots.add(falls_below(f, a, b));
    if (at_a < 0 && at_b >= 0) roots.add(falls_below([&](double t) { return -f(t); }, a, b));
  }
  roots.end();
  return roots;
}

}  // namespace

SolidEntry first_entry(const Torus& torus, const Vector3d& p_from, const Vector3d& p_to) noexcept {
  const Vector3d from = torus.to_shape(p_from), way = torus.to_shape(p_to) - from;
  const auto outside = [&](double t) {
    const Vector3d p = from + t * way;
    const double across = std::sqrt(p.x() * p.x() + p.y() * p.y()) - torus.radius;
    return std::sqrt(across * across + p.z() * p.z()) - torus.tube;
  };
  if (!(outside(0) >= 0)) return {};
  // The surface bounds a ball, which most paths miss.
  const double reach = torus.radius + torus.tube;
  const double nearest = std::clamp(-from.dot(way) / way.squaredNorm(), 0.0, 1.0);
  if (!((from + nearest * way).squaredNorm() <= reach * reach)) return {};
  // (|p|^2 + R^2 - r^2)^2 - 4 R^2 (x^2 + y^2), in multiples of R, along the path: a polynomial of
  // the fourth degree that is negative inside.
  const Vector3d u = from / torus.radius, w = way / torus.radius;
  const double ratio = torus.tube / torus.radius;
  const double s = u.squaredNorm() + 1 - ratio * ratio, m = 2 * u.dot(w), q = w.squaredNorm();
  const double c4 = q * q, c3 = 2 * q * m;
  const double c2 = 2 * q * s + m * m - 4 * (w.x() * w.x() + w.y() * w.y());
  const double c1 = 2 * m * s - 8 * (u.x() * w.x() + u.y() * w.y());
  const auto slope = [&](double t) { return ((4 * c4 * t + 3 * c3) * t + 2 * c2) * t + c1; };
  // Where the slope is steepest, in order.
  Places steepest;
  const Roots bends = roots_of(6 * c4, 1.5 * c3, c2);
  for (std::size_t i = 0; i < bends.count; ++i) steepest.add(bends.t[i]);
  steepest.end();
  const Places extrema = roots_between(slope, steepest);
  for (std::size_t i = 0; i + 1 < extrema.count; ++i) {
    const double a = extrema.t[i], b = extrema.t[i + 1];
    if (!(outside(a) >= 0 && outside(b) < 0)) continue;
    return {.triangle = 0, .parameter = falls_below(outside, a, b)};
  }
  return {};
}

}  // namespace thimble::render::shape_solid
