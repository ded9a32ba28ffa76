#include "view/overlays/tip_trail.h"

#include <Eigen/Core>
#include <algorithm>

namespace thimble::view {
namespace {

constexpr double kStep = 3e-4;                    // m: a pixel of a typical picture
constexpr std::int64_t kTimeMin_ns = 10'000'000;  // limits the trail to 400 points

}  // namespace

void TipTrail::add(const driver::TickRecord& tick) {
  if (!kept_.empty() && tick.time_ns < kept_.back().time_ns) kept_.clear();
  while (!kept_.empty() &&
         static_cast<double>(tick.time_ns - kept_.front().time_ns) > kSeconds * 1e9) {
    kept_.pop_front();
  }
  // During contact on the surface, where it is visible.
  const Eigen::Map<const Eigen::Vector3d> p_WT(tick.in_contact ? tick.p_WP.data()
                                                               : tick.p_WT.data());
  const double force = Eigen::Map<const Eigen::Vector3d>(tick.f_sent_W.data()).norm();
  if (!p_WT.allFinite() || !(force >= 0)) return;
  if (!kept_.empty()) {
    Kept& last = kept_.back();
    const bool moved = (p_WT - last.point.p_WT).norm() >= kStep;
    // Between two points the largest force counts, so that a short impact is visible.
    if (!moved || tick.time_ns - last.time_ns < kTimeMin_ns) {
      last.point.force = std::max(last.point.force, force);
      return;
    }
  }
  kept_.push_back({tick.time_ns, {p_WT, force}});
}

void TipTrail::copy_to(std::vector<TrailPoint>& trail) const {
  trail.clear();
  for (const Kept& kept : kept_) trail.push_back(kept.point);
}

}  // namespace thimble::view
