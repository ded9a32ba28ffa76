#include "bringup/identify/encoders.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace thimble::bringup {
namespace {

// Min. number of differences of one size; fewer may be misread counts
constexpr int kSeenMin = 3;
constexpr std::size_t kReportsMin = 100;
// If none of n reports changes, the probability of a change is below 3/n in 19 of 20 rests: the
// rule of three [M Hanley and Lippman-Hand 1983].
constexpr double kRuleOfThree = 3;
// Allowed difference between the two halves of a rest in counts. A multiple of the standard error
// of their noise, and a constant part [chosen: half a step is the effect of rounding].
constexpr double kDriftMax = 4, kDriftFree = 0.5;

EncoderStep step_of(const ArmMotion& motion, Eigen::Index joint) {
  std::map<int, int> differences;  // number of differences, by size
  const MotionSample* before = nullptr;
  for (const MotionSample& sample : motion.samples) {
    if (!sample.fresh) continue;
    if (before != nullptr) {
      const double counts = (sample.q[joint] - before->q[joint]) / motion.step[joint];
      ++differences[static_cast<int>(std::lround(std::abs(counts)))];
    }
    before = &sample;
  }
  for (const auto& [counts, seen] : differences) {
    if (counts > 0 && seen >= kSeenMin) return {.counts = counts, .seen = seen};
  }
  return {};
}

}  // namespace

std::array<EncoderStep, 3> encoder_steps(const ArmMotion& motion) {
  return {step_of(motion, 0), step_of(motion, 1), step_of(motion, 2)};
}

EncoderRest noise_at_rest(const std::vector<std::array<std::int32_t, 3>>& counts) {
  EncoderRest rest;
  rest.reports = counts.size();
  if (counts.size() < kReportsMin) return rest;
  const auto n = static_cast<double>(counts.size() - 1);
  for (std::size_t joint = 0; joint < 3; ++joint) {
    double second = 0, fourth = 0, halves = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double from_first = counts[i][joint] - counts[0][joint];
      halves += (2 * i < counts.size() ? -2 : 2) * from_first / static_cast<double>(counts.size());
      if (i == 0) continue;
      const double d = counts[i][joint] - counts[i - 1][joint];
      second += d * d / n;
      fourth += d * d * d * d / n;
    }
    Estimate& noise = rest.noise[joint];
    // The squared difference of two reports is twice the squared error of one. Adjacent differences
    // share a report, which widens the mean of the squares by the factor 3/2.
    noise.value = std::sqrt(second / 2);
    const double spread = std::sqrt(std::max(0.0, 1.5 * (fourth - second * second)) / n);
    noise.plus_minus =
        second > 0 ? kNormal95 * spread / (4 * noise.value) : std::sqrt(kRuleOfThree / n / 2);
    const double error = noise.value * std::sqrt(4 / n);
    rest.at_rest[joint] = std::abs(halves) <= kDriftFree + kDriftMax * error;
  }
  return rest;
}

EncoderRest encoders_at_rest(BenchArm& bench, double seconds, const std::atomic<bool>& stop) {
  std::vector<std::array<std::int32_t, 3>> counts;
  counts.reserve(static_cast<std::size_t>(1000 * seconds) + 1);
  const auto watch = [&counts](const driver::DeviceState& state) -> Eigen::Vector3d {
    if (state.fresh) counts.push_back({state.counts[0], state.counts[1], state.counts[2]});
    return {0, 0, 0};
  };
  bench.run(seconds, watch, stop);
  return noise_at_rest(counts);
}

}  // namespace thimble::bringup
