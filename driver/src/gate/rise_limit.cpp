#include "gate/rise_limit.h"

#include <algorithm>
#include <cmath>

namespace thimble::driver {
namespace {

using Eigen::Vector3d;

/// Returns the point on the way from one force to another that is at most `rise` away.
Vector3d towards(const Vector3d& from, const Vector3d& to, double rise) noexcept {
  const Vector3d way = to - from;
  const double length = way.norm();
  if (length <= rise) return to;
  return from + rise / length * way;
}

}  // namespace

Vector3d limit_rise(const Vector3d& f_W, const Vector3d& f_last_W, const Vector3d& v_WT,
                    double rise, double speed_floor) noexcept {
  const double square_now = f_W.squaredNorm();
  const double square_last = f_last_W.squaredNorm();
  const double kept = square_now < square_last ? std::sqrt(square_now / square_last) : 1;
  const Vector3d held = towards(kept * f_last_W, f_W, rise);
  const double power_held = held.dot(v_WT);
  if (!(power_held > f_W.dot(v_WT)) || !(v_WT.squaredNorm() > speed_floor * speed_floor)) {
    return held;
  }
  const double share = square_last > 0 ? std::clamp(f_W.dot(f_last_W) / square_last, 0.0, 1.0) : 0;
  const Vector3d dropped = towards(share * f_last_W, f_W, rise);
  return dropped.dot(v_WT) < power_held ? dropped : held;
}

}  // namespace thimble::driver
