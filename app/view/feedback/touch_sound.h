#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "view/feedback/tick_upsampler.h"

namespace thimble::view {

/// Makes sound of what a run felt, tick by tick: what of the force is faster than kLowest is heard
/// as it is, a touch that begins clicks, and friction hisses. Silent where nothing touches, and
/// where a touch rests. The same ticks make the same samples. Real-time: never from the servo
/// thread.
class TouchSound {
 public:
  /// Samples a second: what every sound card plays.
  static constexpr int kRate = 48000;
  /// Hz; below, a person feels a force and not a vibration. [chosen, as the task of a high-pass:
  /// the ear hears from about 20 Hz on]
  static constexpr double kLowest = 30;
  /// No sample is louder, of 1. Chosen: half of what a card can play.
  static constexpr double kLoudest = 0.5;

  /// Prepares for ticks that are `period_ns` apart (10 us to 1 s; others are taken as those).
  explicit TouchSound(std::int64_t period_ns);

  /// Takes a tick and appends its sound: kRate times the period, -kLoudest to kLoudest. Up to
  /// kGapMost of ticks that are missing stand as the one after them; a longer gap is silence of its
  /// beginning's length.
  void take(const driver::TickRecord& tick, std::vector<float>& samples);

 private:
  static constexpr double kGapMost = 0.05;  // s, chosen: what is held longer is heard as a fault

  void reset();
  double vibration(const Eigen::Vector3d& f);
  void begin_touch(const driver::TickRecord& tick);
  double added_sample();
  void one_tick(const driver::TickRecord& tick, std::vector<float>& samples);

  double period_;  // s
  std::int64_t period_ns_;
  std::int64_t last_ns_ = 0;
  bool any_ = false;
  // The high-pass, of the three parts of the force.
  std::array<double, 5> high_pass_{};  // b0, b1, b2, a1, a2
  std::array<Eigen::Vector3d, 2> high_pass_state_;
  Eigen::Matrix3d spread_;     // of what passed, N^2
  Eigen::Vector3d direction_;  // along which it is heard
  TickUpsampler upsampler_;
  // The click: a decaying sine, as a number that turns and shrinks with each sample.
  double click_ = 0, click_aside_ = 0;
  double hiss_ = 0;  // how loud friction is
  std::uint64_t noise_;
  double noise_low_ = 0, noise_band_ = 0;
  double gate_ = 0;       // 0 silent, 1 open
  double untouched_ = 1;  // s since something touched
};

/// Returns the sound of a whole touch, such as a recording's. As TouchSound.
std::vector<float> sound_of(const std::vector<driver::TickRecord>& ticks, std::int64_t period_ns);

}  // namespace thimble::view
