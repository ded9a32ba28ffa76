#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "bringup/bench_arm.h"
#include "bringup/estimate.h"
#include "bringup/identify/arm_motion.h"

namespace thimble::bringup {

/// What the reports of a moving arm say of one encoder's step.
struct EncoderStep {
  /// The smallest difference between two reports, in steps of the arm file: a whole number, so that
  /// it is known without an interval. 1: it counts as finely as it says. 0: it never moved.
  int counts = 0;
  int seen = 0;  ///< Differences that were as small as that.
};

/// What encoders tell of a tip that nobody moves.
struct EncoderRest {
  /// RMS of what a report of each encoder is off, in steps of the arm file. Where none ever
  /// changed, 0 and what would have been seen in 19 of 20 such rests.
  std::array<Estimate, 3> noise;
  std::array<bool, 3> at_rest{};  ///< It did not drift, so that changes are noise.
  std::size_t reports = 0;        ///< That were compared.
};

/// Steps of the encoders, and their noise if it was looked for.
struct Encoders {
  std::array<EncoderStep, 3> step;
  std::optional<EncoderRest> rest;
};

/// Returns the smallest difference between following reports of a motion, joint by joint.
/// Differences that were seen once or twice are left out: a misread count is one. Real-time: never
/// from the servo thread.
std::array<EncoderStep, 3> encoder_steps(const ArmMotion& motion);

/// Returns the noise of counts that followed each other, report by report, each three joints. It is
/// that of the differences (von Neumann), so that slow creep is not in it; noise that hangs
/// together from report to report is taken for less than it is. Real-time: never from the servo
/// thread.
EncoderRest noise_at_rest(const std::vector<std::array<std::int32_t, 3>>& counts);

/// Watches the reports of an idle arm, which gets no force, for `seconds`. Real-time: never from
/// the servo thread.
EncoderRest encoders_at_rest(BenchArm& bench, double seconds, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
