#include "body/shape/snap_truss.h"

#include <algorithm>
#include <cmath>

#include "math/elementary.h"

namespace thimble::render {

SnapTruss::SnapTruss(double half_span, double rise, double bar_stiffness) noexcept {
  const auto usable = [](double x) { return x > 0 && std::isfinite(x); };
  if (!usable(half_span) || !usable(rise) || !usable(bar_stiffness)) return;
  half_span_ = half_span;
  rise_ = rise;
  k_ = bar_stiffness;
  bar_ = math::hypot(half_span, rise);
}

// Shortening of the bars relative to rest: L0^2 - L^2 = u (2 H - u), without the cancellation of L0
// - L in a flat truss.
double SnapTruss::shortening(double u, double length) const noexcept {
  return u * (2 * rise_ - u) / (bar_ + length);
}

double SnapTruss::force(double u) const noexcept {
  const double y = rise_ - u;
  const double length = math::hypot(half_span_, y);
  return 2 * k_ * shortening(u, length) / length * y;
}

double SnapTruss::energy(double u) const noexcept {
  const double shorter = shortening(u, math::hypot(half_span_, rise_ - u));
  return k_ * shorter * shorter;
}

double SnapTruss::stiffness(double u) const noexcept {
  const double length = math::hypot(half_span_, rise_ - u);
  return 2 * k_ * (1 - bar_ * half_span_ * half_span_ / (length * length * length));
}

std::optional<double> SnapTruss::limit_point(double spring) const noexcept {
  // The place where the stiffness of the truss is minus that of the spring.
  if (!valid() || !(spring >= 0)) return std::nullopt;
  const double length = math::cbrt(bar_ * half_span_ * half_span_ / (1 + spring / (2 * k_)));
  if (!(length > half_span_)) return std::nullopt;
  return rise_ - std::sqrt((length - half_span_) * (length + half_span_));
}

double SnapTruss::limit_load() const noexcept {
  const auto at = limit_point();
  return at ? force(*at) : 0;
}

std::optional<double> SnapTruss::settle(double load, double spring, bool snapped) const noexcept {
  if (!valid() || !std::isfinite(load) || !(spring >= 0) || !std::isfinite(spring)) {
    return std::nullopt;
  }
  // Beyond the limit points F(u) + spring u rises with u. Far out its slope is at least 2 k, less
  // the effect of the bars' own length: this gives the ends of the brackets.
  const double reach = bar_ + rise_ + (std::abs(load) + spring * rise_) / (2 * k_ + spring);
  const auto limit = limit_point(spring);
  double low = rise_ - reach;
  double high = rise_ + reach;
  if (limit && snapped) low = 2 * rise_ - *limit;
  if (limit && !snapped) high = *limit;
  const auto excess = [&](double u) { return force(u) + spring * u - load; };
  if (!(excess(low) <= 0) || !(excess(high) >= 0)) return std::nullopt;
  // Newton's iteration inside a shrinking bracket; bisection where Newton leaves it.
  double u = std::clamp(snapped ? 2 * rise_ : 0.0, low, high);
  constexpr int kRoundsMax = 80;
  for (int round = 0; round < kRoundsMax; ++round) {
    const double off = excess(u);
    if (off == 0) return u;
    (off > 0 ? high : low) = u;
    const double slope = stiffness(u) + spring;
    double next = u - off / slope;
    if (!(next > low && next < high)) next = low + (high - low) / 2;
    if (next == u || !(high - low > 1e-16 * reach)) return next;
    u = next;
  }
  return u;
}

}  // namespace thimble::render
