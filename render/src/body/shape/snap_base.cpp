#include "body/shape/snap_base.h"

#include <algorithm>
#include <cmath>

namespace thimble::render {

void SnapBase::follow(double load, double spring, double step) noexcept {
  // Written so that NaN moves nothing.
  if (!(step > 0) || !(speed_max_ > 0)) return;
  const auto first = truss_.settle(load, spring, false);
  const auto second = truss_.settle(load, spring, true);
  if (!first && !second) return;
  double target = first ? *first : *second;
  bool snapped = snapped_;
  if (!truss_.limit_point(spring)) {
    // A spring so stiff that nothing jumps has one resting place. It counts as snapped from where
    // it would stay in if released, and as not snapped from where it would return if released.
    const double limit = truss_.limit_point().value_or(truss_.rise());
    if (target > 2 * truss_.rise() - limit) snapped = true;
    if (target < limit) snapped = false;
    running_ = running_ && snapped == snapped_;
  } else {
    // Chooses the resting place to which the forces lead from here. If the load is more than the
    // bars can hold, it moves inwards, and stops at the first shape only if that is still ahead.
    const bool inwards = truss_.force(u_) + spring * u_ < load;
    snapped = !first || (second && (inwards ? *first < u_ : *second <= u_));
    if (snapped && second) target = *second;
    running_ = running_ || snapped != snapped_;
  }
  if (snapped != snapped_) {
    snapped_ = snapped;
    ++snaps_;
  }
  const double most = speed_max_ * step;
  const double from = u_;
  u_ += std::clamp(target - from, -most, most);
  if (!running_) return;
  // Work of the load and of the spring's pull over the path, less the energy taken up by the bars.
  const double work = load * (u_ - from) - spring * (u_ * u_ - from * from) / 2;
  released_ += work - (truss_.energy(u_) - truss_.energy(from));
  running_ = u_ != target;
}

}  // namespace thimble::render
