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

/// One encoder's step, from the reports of a moving arm.
struct EncoderStep {
  /// The smallest difference between two reports, in steps of the arm file. It is an integer, so it
  /// is known without an interval. 1: the encoder has the resolution of the file. 0: it never
  /// moved.
  int counts = 0;
  int seen = 0;  ///< Number of smallest differences.
};

/// Noise of the encoders while the tip is at rest.
struct EncoderRest {
  /// RMS error of a report of each encoder, in steps of the arm file. If none ever changed: 0, and
  /// the noise that would have been seen in 19 of 20 such rests.
  std::array<Estimate, 3> noise;
  std::array<bool, 3> at_rest{};  ///< No drift, so that changes are noise.
  std::size_t reports = 0;        ///< Number of compared reports.
};

/// Steps of the encoders, and their noise if it was measured.
struct Encoders {
  std::array<EncoderStep, 3> step;
  std::optional<EncoderRest> rest;
};

/// Returns the smallest difference between consecutive reports of a motion, joint by joint.
/// Differences seen once or twice are omitted: they may be misread counts. Real-time: never from
/// the servo thread.
std::array<EncoderStep, 3> encoder_steps(const ArmMotion& motion);

/// Returns the noise of consecutive counts, report by report, three joints each. It is computed
/// from differences (von Neumann), so that it excludes slow creep; noise that is correlated between
/// reports is underestimated. Real-time: never from the servo thread.
EncoderRest noise_at_rest(const std::vector<std::array<std::int32_t, 3>>& counts);

/// Watches the reports of an idle arm, which gets no force, for `seconds`. Real-time: never from
/// the servo thread.
EncoderRest encoders_at_rest(BenchArm& bench, double seconds, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
