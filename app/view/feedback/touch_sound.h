#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "view/feedback/tick_upsampler.h"

namespace thimble::view {

/// Converts the contact of a run to sound, tick by tick. The part of the force above kLowest is
/// played directly, a touch that begins clicks, and friction hisses. It is silent without contact
/// and for a contact at rest. The same ticks give the same samples. Real-time: never from the servo
/// thread.
class TouchSound {
 public:
  /// Samples a second, supported by every sound card.
  static constexpr int kRate = 48000;
  /// Hz; below it, a person feels a force and not a vibration. [chosen, as the corner of a
  /// high-pass: people hear from about 20 Hz]
  static constexpr double kLowest = 30;
  /// Bound of the absolute value of a sample; full scale is 1. Chosen: half of what a card can
  /// play.
  static constexpr double kLoudest = 0.5;

  /// Prepares for ticks that are `period_ns` apart, clamped to 10 us to 1 s.
  explicit TouchSound(std::int64_t period_ns);

  /// Takes a tick and appends its sound: kRate times the period, -kLoudest to kLoudest. Missing
  /// ticks up to kGapMax are replaced by the one after them. A longer gap is silent.
  void take(const driver::TickRecord& tick, std::vector<float>& samples);

 private:
  static constexpr double kGapMax = 0.05;  // s, chosen: a longer held value is audible as an error

  void reset();
  double vibration(const Eigen::Vector3d& f);
  void begin_touch(const driver::TickRecord& tick);
  double added_sample();
  void one_tick(const driver::TickRecord& tick, std::vector<float>& samples);

  double period_;  // s
  std::int64_t period_ns_;
  std::int64_t last_ns_ = 0;
  bool any_ = false;
  // Coefficients of the high-pass for the three components of the force.
  std::array<double, 5> high_pass_{};  // b0, b1, b2, a1, a2
  std::array<Eigen::Vector3d, 2> high_pass_state_;
  Eigen::Matrix3d spread_;     // covariance of the filtered force, N^2
  Eigen::Vector3d direction_;  // direction of the vibration that is played
  TickUpsampler upsampler_;
  // State of the click: a decaying sine, as a complex number that rotates and shrinks with each
  // sample.
  double click_ = 0, click_aside_ = 0;
  double hiss_ = 0;  // amplitude of the friction noise
  std::uint64_t noise_;
  double noise_low_ = 0, noise_band_ = 0;
  double gate_ = 0;       // 0 silent, 1 open
  double untouched_ = 1;  // s since the last contact
};

/// Returns the sound of a whole touch, for example of a recording. As TouchSound.
std::vector<float> sound_of(const std::vector<driver::TickRecord>& ticks, std::int64_t period_ns);

}  // namespace thimble::view
