#include "gate/program_watch.h"

#include <algorithm>
#include <cmath>

namespace thimble::driver {
namespace {

/// Returns by how much a force must return from its extreme to count as turned, N, after a swing of
/// `swing`. It is more than a stiff wall's answer to one or two counts.
double turn_of(double swing) noexcept {
  constexpr double kReturnMin = 0.1;  // N [chosen]
  return std::max(kReturnMin, swing / 4);
}

}  // namespace

void ProgramWatch::restart() noexcept {
  axes_.fill({});
  begun_ = false;
  time_ = 0;
  share_ = max_share_ = 1;
  muted_ = quiet_ = 0;
}

double ProgramWatch::share(const Eigen::Vector3d& f_asked_W, const Eigen::Vector3d& f_sent_W,
                           const Eigen::Vector3d& p_WT, double dt) noexcept {
  // Written so that numbers that are not finite are skipped; the gate makes them a fault.
  if (!(f_asked_W.squaredNorm() + p_WT.squaredNorm() < HUGE_VAL && dt >= 0)) return share_;
  time_ += dt;
  const bool limited = f_asked_W.squaredNorm() > force_max_ * force_max_;
  const Axis* oscillates = nullptr;
  for (std::size_t i = 0; i < 3; ++i) {
    Axis& axis = axes_[i];
    const auto k = static_cast<Eigen::Index>(i);
    if (begun_) {
      axis.work += f_sent_W[k] * (p_WT[k] - p_WT_[k]);
    } else {
      axis.turn = axis.farthest = {.f = f_asked_W[k], .x = p_WT[k], .time = time_};
    }
    if (follow(axis, f_asked_W[k], p_WT[k], limited) && axis.oscillates(force_max_)) {
      oscillates = &axis;
    }
  }
  begun_ = true;
  p_WT_ = p_WT;
  quiet_ += dt;
  if (muted_ > 0) {
    muted_ -= dt;
  } else if (oscillates != nullptr) {
    found(*oscillates);
  } else if (share_ < max_share_) {
    share_ = std::min(max_share_, share_ + max_share_ * dt / kReturn);
  } else if (max_share_ < 1 && quiet_ > kForget) {
    max_share_ = std::min(1.0, max_share_ + dt / kForget);
  }
  return share_;
}

void ProgramWatch::found(const Axis& axis) noexcept {
  ++oscillations_;
  frequency_ = 1 / (axis.halves[0].time + axis.halves[1].time);
  max_share_ = std::max(kShareMin, kLess * std::max(share_, kShareMin));
  share_ = 0;
  muted_ = kMute;
  quiet_ = 0;
  // The spring remains known; its oscillation must be observed again.
  for (Axis& one : axes_) one.known = std::min<std::size_t>(one.known, 1);
}

/// Follows the force along an axis; returns whether it has turned.
bool ProgramWatch::follow(Axis& axis, double f, double x, bool limited) noexcept {
  Extreme& farthest = axis.farthest;
  if (f != axis.f) {
    axis.f = f;
    axis.since = time_;
  } else if (time_ - axis.since > kLongest) {
    // A force that was constant for this long starts again.
    axis.turn = farthest = {f, x, time_, axis.work, limited};
    axis.known = 0;
    return false;
  }
  const double swing = std::abs(farthest.f - axis.turn.f);
  const double ahead = axis.direction * (f - farthest.f);
  if (ahead >= 0) {
    farthest = {f, x, time_, axis.work, farthest.limited || limited};
    // A constant force is not oscillating yet.
    if (f == axis.turn.f) axis.turn = farthest;
    return false;
  }
  farthest.limited = farthest.limited || limited;
  if (-ahead < turn_of(swing)) return false;
  std::copy_backward(axis.halves.begin(), axis.halves.end() - 1, axis.halves.end());
  axis.halves[0] = {.swing = swing,
                    .way = std::abs(farthest.x - axis.turn.x),
                    .time = farthest.time - axis.turn.time,
                    .work = farthest.work - axis.turn.work,
                    .limited = farthest.limited};
  const Half& now = axis.halves[0];
  if (axis.known == 0 || axis.halves[1].time > kLongest) {
    constexpr double kTouch = 1e-4;  // m [chosen: some counts]
    axis.stiffness = now.work < 0 && now.way >= kTouch ? now.swing / now.way : 0;
  }
  axis.known = std::min(axis.known + 1, kHalves);
  axis.turn = farthest;
  farthest = {f, x, time_, axis.work, limited};
  axis.direction = -axis.direction;
  return true;
}

/// Returns whether the force did work on the tip in the cycle of half `i` and the one before.
bool ProgramWatch::Axis::feeds(std::size_t i, double force_max) const noexcept {
  const Half &a = halves[i], &b = halves[i + 1];
  const double time = a.time + b.time;
  // The work of a cycle is pi / 4 of swing times way, times the sine of the lag.
  constexpr double kLag = 0.01;
  const double swing = std::min((a.swing + b.swing) / 2, 2 * force_max);
  return time >= kShortest && time <= kLongest &&
         a.work + b.work > kLag * swing * (a.way + b.way) / 2;
}

/// Returns whether the newest halves have the stiffness of the touch.
bool ProgramWatch::Axis::springs(std::size_t count) const noexcept {
  constexpr double kSame = 1.4;  // effect of a count and of the wire's delay [chosen]
  if (!(stiffness > 0)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const double force = stiffness * halves[i].way;
    if (!(halves[i].swing < kSame * force && force < kSame * halves[i].swing)) return false;
  }
  return true;
}

bool ProgramWatch::Axis::oscillates(double force_max) const noexcept {
  constexpr std::size_t kGrowing = 5;
  if (known < kGrowing || !(feeds(0, force_max) && feeds(1, force_max) && feeds(2, force_max))) {
    return false;
  }
  // Returns whether a half is at least `factor` times the one `back` before.
  const auto beyond = [this](std::size_t i, std::size_t back, double factor) {
    return halves[i].swing >= factor * halves[i + back].swing &&
           halves[i].way >= factor * halves[i + back].way;
  };
  constexpr double kSteady = 0.97;
  if (halves[0].way >= kWay && springs(kGrowing)) {
    if (beyond(0, 2, kGrowth) && beyond(1, 2, kGrowth) && beyond(2, 2, kGrowth)) return true;
    if (known == kHalves && springs(kHalves) && feeds(4, force_max) &&
        (halves[0].time + halves[1].time) * kHandMax < 1 && beyond(0, 6, kSteady) &&
        beyond(1, 6, kSteady)) {
      return true;
    }
  }
  const auto at_limit = [&](std::size_t i) {
    return halves[i].way >= kWayAtLimit && (halves[i].limited || halves[i + 1].limited) &&
           beyond(i, 2, kSteady);
  };
  return at_limit(0) && at_limit(1) && at_limit(2);
}

}  // namespace thimble::driver
