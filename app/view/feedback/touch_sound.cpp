#include "view/feedback/touch_sound.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "log/progress.h"

namespace thimble::view {
namespace {

using Eigen::Vector3d;

// All values below are chosen by listening: an everyday touch is clearly audible and not clipped.
constexpr double kPerNewton = 0.4;     // per newton of vibration
constexpr double kSpreadTime = 0.05;   // s, time constant of the direction of the vibration
constexpr double kClickHz = 400;       // tap of a hard object: A(v) e^-Bt sin wt [Okamura]
constexpr double kClickTime = 0.008;   // s, decay to 1/e
constexpr double kClickSpeed = 0.2;    // m/s at which a click is loudest
constexpr double kClickMax = 0.4;      // of full scale 1
constexpr double kHissPerWatt = 0.25;  // of full scale 1, per root of the friction power
constexpr double kHissMax = 0.1;
constexpr double kHissHz = 900;     // centre frequency of the noise
constexpr double kHissWidth = 0.7;  // 1/Q of the band-pass
constexpr double kOpen = 0.002;     // s, opening time of the gate
constexpr double kHold = 0.06;      // s that the gate stays open after the last contact, so that a
                                    // click can decay
constexpr double kClose = 0.02;     // s, closing time of the gate

constexpr std::uint64_t kNoiseSeed = 0x9e3779b97f4a7c15;                 // any but 0
constexpr std::int64_t kPeriodMin = 10'000, kPeriodMax = 1'000'000'000;  // ns

Vector3d vector(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

TouchSound::TouchSound(std::int64_t period_ns)
    : period_ns_(std::clamp(period_ns, kPeriodMin, kPeriodMax)),
      upsampler_(1e-9 * static_cast<double>(period_ns_) * kRate) {
  period_ = 1e-9 * static_cast<double>(period_ns_);
  // Butterworth high-pass of second order by the bilinear transform [S: R. Bristow-Johnson, Audio
  // EQ Cookbook]. If the tick rate is too low for frequencies above kLowest, nothing passes.
  const double turn = 2 * std::numbers::pi * std::min(kLowest * period_, 0.49);
  const double alpha = std::sin(turn) * std::numbers::sqrt2 / 2;
  const double cosine = std::cos(turn);
  const double a0 = 1 + alpha;
  high_pass_ = {(1 + cosine) / 2 / a0, -(1 + cosine) / a0, (1 + cosine) / 2 / a0, -2 * cosine / a0,
                (1 - alpha) / a0};
  noise_ = kNoiseSeed;
  reset();
}

void TouchSound::reset() {
  high_pass_state_ = {Vector3d::Zero(), Vector3d::Zero()};
  spread_.setZero();
  direction_ = Vector3d::UnitZ();
  upsampler_.reset();
  click_ = click_aside_ = hiss_ = noise_low_ = noise_band_ = gate_ = 0;
  untouched_ = kHold + kClose;
}

/// Returns the fast part of the force as one number: its component along the direction of largest
/// variation, which turns slowly. The norm of the force would turn an oscillation of 250 Hz into
/// 500.
double TouchSound::vibration(const Vector3d& f) {
  const auto& [b0, b1, b2, a1, a2] = high_pass_;
  const Vector3d fast = b0 * f + high_pass_state_[0];
  high_pass_state_[0] = b1 * f - a1 * fast + high_pass_state_[1];
  high_pass_state_[1] = b2 * f - a2 * fast;
  const double share = std::min(1.0, period_ / kSpreadTime);
  spread_ += share * (fast * fast.transpose() - spread_);
  // A step of the power iteration: the direction of largest variation grows fastest. The sign is
  // kept.
  const Vector3d turned = spread_ * direction_;
  if (turned.norm() > 1e-3 * spread_.trace()) direction_ = turned.normalized();
  return direction_.dot(fast);
}

void TouchSound::begin_touch(const driver::TickRecord& tick) {
  const double speed = std::max(0.0, -vector(tick.v_WT).dot(vector(tick.n_W)));
  click_ = 0;
  click_aside_ = kClickMax * std::min(1.0, speed / kClickSpeed);
}

/// Returns the next sample of click and hiss.
double TouchSound::added_sample() {
  static const double kTurn = 2 * std::numbers::pi * kClickHz / kRate;
  static const double kShrink = std::exp(-1 / (kClickTime * kRate));
  static const double kSine = kShrink * std::sin(kTurn);
  static const double kCosine = kShrink * std::cos(kTurn);
  const double click = click_;
  click_ = kCosine * click + kSine * click_aside_;
  click_aside_ = kCosine * click_aside_ - kSine * click;
  // xorshift64 [S: G. Marsaglia, Xorshift RNGs, 2003].
  noise_ ^= noise_ << 13U;
  noise_ ^= noise_ >> 7U;
  noise_ ^= noise_ << 17U;
  const double white = static_cast<double>(noise_ >> 11U) * 0x1p-52 - 1;
  // State-variable filter, band-pass output [S: H. Chamberlin, Musical Applications].
  static const double kTune = 2 * std::sin(std::numbers::pi * kHissHz / kRate);
  noise_low_ += kTune * noise_band_;
  noise_band_ += kTune * (white - noise_low_ - kHissWidth * noise_band_);
  return click + hiss_ * noise_band_;
}

void TouchSound::one_tick(const driver::TickRecord& tick, std::vector<float>& samples) {
  const Vector3d f = vector(tick.f_sent_W);
  const bool touches = tick.in_contact && f.allFinite();
  if (touches && untouched_ > 0) begin_touch(tick);
  untouched_ = touches ? 0 : untouched_ + period_;
  if (untouched_ >= kHold + kClose) reset();
  const double fast = vibration(touches ? f : Vector3d::Zero());
  hiss_ = 0;
  if (touches) {
    const Vector3d n = vector(tick.n_W);
    const Vector3d aside = f - f.dot(n) * n;
    const double power = std::abs(aside.dot(vector(tick.v_WT)));
    hiss_ = std::min(kHissMax, kHissPerWatt * std::sqrt(power));
  }
  if (!std::isfinite(hiss_)) hiss_ = 0;
  const bool open = untouched_ < kHold;
  const double step = (open ? 1 / kOpen : -1 / kClose) / kRate;
  upsampler_.take(kPerNewton * fast, [&](double sample) {
    gate_ = std::clamp(gate_ + step, 0.0, 1.0);
    const double sum = gate_ * (sample + added_sample());
    // Soft limit: stays below kLoudest.
    samples.push_back(static_cast<float>(kLoudest * std::tanh(sum / kLoudest)));
  });
}

void TouchSound::take(const driver::TickRecord& tick, std::vector<float>& samples) {
  const std::int64_t since = tick.time_ns - last_ns_;
  const bool first = !any_;
  any_ = true;
  last_ns_ = tick.time_ns;
  if (!first) {
    const std::int64_t missing = (since + period_ns_ / 2) / period_ns_ - 1;
    const bool held = missing > 0 && static_cast<double>(missing) * period_ <= kGapMax;
    if (since <= 0 || (missing > 0 && !held)) reset();
    for (std::int64_t i = 0; held && i < missing; ++i) one_tick(tick, samples);
  }
  one_tick(tick, samples);
}

std::vector<float> sound_of(const std::vector<driver::TickRecord>& ticks, std::int64_t period_ns) {
  TouchSound sound(period_ns);
  std::vector<float> samples;
  scene::Progress progress("sound");
  std::size_t done = 0;
  for (const driver::TickRecord& tick : ticks) {
    sound.take(tick, samples);
    progress.set_share(++done, ticks.size());
  }
  return samples;
}

}  // namespace thimble::view
