#include "thimble/render/body/snap_base.h"

#include <algorithm>
#include <cmath>

namespace thimble::render {

void SnapBase::follow(double load, double spring, double step) noexcept {
  // Written so that NaN moves nothing.
  if (!(step > 0) || !(speed_max_ > 0)) return;
  auto target = truss_.settle(load, spring, snapped_);
  if (!target) {
    target = truss_.settle(load, spring, !snapped_);
    if (!target) return;
    snapped_ = !snapped_;
    running_ = true;
    ++snaps_;
  }
  const double most = speed_max_ * step;
  const double from = u_;
  u_ += std::clamp(*target - from, -most, most);
  if (!running_) return;
  // The load and the spring's pull over the way gone, less what the bars took up.
  const double work = load * (u_ - from) - spring * (u_ * u_ - from * from) / 2;
  released_ += work - (truss_.energy(u_) - truss_.energy(from));
  running_ = u_ != *target;
}

}  // namespace thimble::render
