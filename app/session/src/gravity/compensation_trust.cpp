#include "gravity/compensation_trust.h"

#include <algorithm>

namespace thimble::session {

void CompensationTrust::restart() noexcept {
  begun_ = away_ = false;
  share_ = 1;
  trial_ = rest_ = way_ = 0;
  v_W_.setZero();
}

void CompensationTrust::judge(double along, double dt, bool others) noexcept {
  if (away_) {
    rest_ = v_W_.norm() <= kRestSpeed ? rest_ + dt : 0;
    if (rest_ < kRest) return;
    away_ = false;
    trial_ = rest_ = way_ = 0;
    return;
  }
  const bool on_trial = trial_ < kTrial;
  trial_ += dt;
  const bool counts = !others && along > (on_trial ? kRestSpeed : kFast);
  way_ = counts ? way_ + along * dt : 0;
  if (way_ <= (on_trial ? kTrialWay : kFastWay)) return;
  away_ = true;
  rest_ = way_ = 0;
  withdrawn_.fetch_add(1, std::memory_order_relaxed);
}

double CompensationTrust::share(const driver::DeviceState& state, const Eigen::Vector3d& f_W,
                                bool others) noexcept {
  constexpr double kPole = 628;  // 1/s: 100 Hz
  const double dt = state.dt;
  const double size = f_W.norm();
  if (!begun_ || !(dt > 0) || !(size > 0)) {
    begun_ = true;
    p_last_W_ = state.p_WT;
    return share_;
  }
  v_W_ += std::min(1.0, kPole * dt) * ((state.p_WT - p_last_W_) / dt - v_W_);
  p_last_W_ = state.p_WT;
  const double along = v_W_.dot(f_W) / size;
  judge(along, dt, others);
  const double fade = std::clamp((kFadeEnds - along) / (kFadeEnds - kFadeBegins), 0.0, 1.0);
  const double wanted = away_ ? 0 : fade;
  share_ = std::min(wanted, share_ + kRamp * dt);  // a fall is never slowed
  return share_;
}

}  // namespace thimble::session
