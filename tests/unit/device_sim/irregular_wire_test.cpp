#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "board/sim_transport.h"
#include "simulated_arm.h"
#include "support/refuses.h"
#include "thimble/driver/clock.h"
#include "vintage_simulation.h"

namespace thimble::device_sim {
namespace {

using support::refuses;

constexpr std::int64_t kMillisecond = 1'000'000;

SimulatedArm arm_with(const SimulatedArmSettings& settings, std::uint64_t seed = 1) {
  return SimulatedArm::make(support::vintage_model(), settings, resting_at(home_tip()), seed)
      .value();
}

SimulatedArmSettings irregular(std::int64_t jitter_ns, double loss) {
  SimulatedArmSettings settings = free_arm();
  settings.wire = {.delay_in_ns = kMillisecond, .jitter_ns = jitter_ns, .loss = loss};
  return settings;
}

/// Reads reports for `periods` periods; returns the delay of each beyond the minimum delay, ns.
std::vector<std::int64_t> lateness(SimulatedArm& arm, int periods) {
  std::vector<std::int64_t> late;
  while (arm.time_ns() < periods * kMillisecond) {
    arm.advance_to(std::max(arm.next_report_ns(), arm.time_ns() + 1));
    if (take(arm)) late.push_back(arm.time_ns() % kMillisecond);
  }
  return late;
}

TEST(IrregularWire, LossAndJitterMatchTheirSettings) {
  constexpr int kPeriods = 20'000;
  constexpr double kLoss = 0.1, kJitter_ns = 800'000;
  SimulatedArm arm = arm_with(irregular(800'000, kLoss));
  const std::vector<std::int64_t> late = lateness(arm, kPeriods);
  const double lost = static_cast<double>(arm.wire_losses());
  EXPECT_NEAR(lost, kLoss * kPeriods, 5 * std::sqrt(kLoss * (1 - kLoss) * kPeriods));
  EXPECT_NEAR(static_cast<double>(late.size()), kPeriods - lost, 2);
  const auto [least, most] = std::minmax_element(late.begin(), late.end());
  EXPECT_LT(*least, 0.01 * kJitter_ns);
  EXPECT_LT(*most, kJitter_ns);
  EXPECT_GT(*most, 0.99 * kJitter_ns);
  double sum = 0;
  for (const std::int64_t ns : late) sum += static_cast<double>(ns);
  const double count = static_cast<double>(late.size());
  EXPECT_NEAR(sum / count, kJitter_ns / 2, 5 * kJitter_ns / std::sqrt(12 * count));
}

TEST(IrregularWire, SameSeedIsBitIdentical) {
  SimulatedArm first = arm_with(irregular(800'000, 0.1), 7);
  SimulatedArm again = arm_with(irregular(800'000, 0.1), 7);
  SimulatedArm other = arm_with(irregular(800'000, 0.1), 8);
  const auto late = lateness(first, 500);
  EXPECT_EQ(late, lateness(again, 500));
  EXPECT_NE(late, lateness(other, 500));
}

TEST(IrregularWire, PreservesTheOrderOfReports) {
  SimulatedArmSettings settings = free_arm();
  settings.wire.jitter_ns = 5 * kMillisecond;
  SimulatedArm arm = arm_with(settings);
  double last = 0;
  int steps = 0;
  for (int k = 0; k < 400; ++k) {
    arm.advance_to(k * 100'000);
    arm.put_message(drive_message(static_cast<std::int16_t>(k), 0, 0));
    const double now = arm.plant().currents().x();
    ASSERT_GE(now, last);
    steps += now > last ? 1 : 0;
    last = now;
  }
  EXPECT_GT(steps, 10);
  arm.advance_to(50 * kMillisecond);
  EXPECT_EQ(arm.plant().currents().x(), 0.399);
}

TEST(IrregularWire, HostWaitsForALateReportUntilItsDeadline) {
  SimulatedArmSettings settings = free_arm();
  settings.wire.jitter_ns = 900'000;
  SimulatedArm arm = arm_with(settings);
  driver::VirtualClock clock;
  SimTransport transport(clock, arm);
  std::array<std::byte, driver::kReportCapacity> buffer;
  for (int k = 1; k <= 500; ++k) {
    const auto read = transport.read_latest(buffer, k * kMillisecond - 1);
    ASSERT_EQ(read.status, driver::TransportStatus::kOk) << k;
    ASSERT_LT(clock.now_ns(), k * kMillisecond);
    clock.sleep_until_ns(k * kMillisecond - 1);
  }
}

TEST(IrregularWire, RefusesInvalidProbabilities) {
  const auto made = [](std::int64_t jitter_ns, double loss) {
    return SimulatedArm::make(support::vintage_model(), irregular(jitter_ns, loss),
                              resting_at(home_tip()));
  };
  EXPECT_TRUE(refuses(made(-1, 0), "jitter"));
  EXPECT_TRUE(refuses(made(0, 1), "loss"));
  EXPECT_TRUE(refuses(made(0, NAN), "loss"));
}

/// Moves the arm to and fro and compares its counters with those of an arm that misses no edge.
struct Missed {
  std::int64_t passed = 0;     // edges of all encoders
  std::uint64_t missed = 0;    // counted by the board
  std::int64_t max_error = 0;  // counts
  driver::hfab::InputReport last{};
};

Missed moved_with(double missed_edges) {
  SimulatedArmSettings settings = phantom_like();
  settings.firmware.missed_edges = missed_edges;
  const auto path = [] {
    return HandPath::make({{0, home_tip()},
                           {0.5, home_tip() + Eigen::Vector3d(0.03, 0.05, -0.03)},
                           {1, home_tip()}})
        .value();
  };
  SimulatedArm arm = SimulatedArm::make(support::vintage_model(), settings, path(), 3).value();
  settings.firmware.missed_edges = 0;
  SimulatedArm right = SimulatedArm::make(support::vintage_model(), settings, path(), 3).value();
  Missed found;
  driver::hfab::InputReport before{};
  for (int k = 0; k < 1500; ++k) {
    arm.advance_to(k * kMillisecond);
    right.advance_to(k * kMillisecond);
    const auto seen = take(arm), truth = take(right);
    if (!seen || !truth) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      found.passed += std::abs(truth->counts[i] - before.counts[i]);
      found.max_error =
          std::max<std::int64_t>(found.max_error, std::abs(seen->counts[i] - truth->counts[i]));
    }
    before = *truth;
    found.last = *seen;
  }
  found.missed = arm.firmware().counters().missed_edges;
  return found;
}

TEST(MissedEdges, FrequencyMatchesTheSetting) {
  constexpr double kChance = 0.02;
  const Missed found = moved_with(kChance);
  const auto passed = static_cast<double>(found.passed);
  EXPECT_GT(passed, 5000);
  EXPECT_NEAR(static_cast<double>(found.missed), kChance * passed,
              5 * std::sqrt(kChance * (1 - kChance) * passed));
  EXPECT_GT(found.max_error, 0.25 * kChance * passed / 6);
}

TEST(MissedEdges, CounterThatMissesAllEdgesDoesNotMove) {
  const Missed found = moved_with(1);
  EXPECT_EQ(found.last.counts, driver::hfab::InputReport{}.counts);
  EXPECT_EQ(found.missed, static_cast<std::uint64_t>(found.passed));
}

}  // namespace
}  // namespace thimble::device_sim
