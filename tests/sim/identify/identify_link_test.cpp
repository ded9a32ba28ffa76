// Timing of an arm's reports, and time of its firmware's watchdog.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "bringup/identify/simulated_bench.h"
#include "bringup/identify/unidentified_parameters.h"
#include "bringup/report_timing.h"
#include "bringup/watchdog_time.h"
#include "support/identify/identified_arm.h"
#include "support/long_form.h"
#include "support/random.h"

namespace thimble::bringup {
namespace {

using support::hidden_arm;
using support::HiddenArm;
using support::identified;
using support::long_form;

ReportTiming timed(const scene::ArmFile& file) {
  auto bench = BenchArm::open(file, {}, {}, {{0, file.workspace.middle()}}, kIdentifyForceMax);
  EXPECT_TRUE(bench.ok());
  const std::atomic<bool> never{false};
  return time_reports(**bench, 2, never);
}

TEST(ReportTiming, MatchesTheSimulatedWire) {
  scene::ArmFile file = scene::load_arm("vintage_phantom").value();
  for (const double period_ms : {1.0, 1.25, 2.0}) {
    file.simulated.firmware.report_period_ns = static_cast<std::int64_t>(1e6 * period_ms);
    for (const double spread_ms : {0.0, 0.1, 0.4}) {
      file.simulated.wire.jitter_ns = static_cast<std::int64_t>(1e6 * spread_ms);
      const ReportTiming timing = timed(file);
      SCOPED_TRACE(std::to_string(period_ms) + " ms, " + std::to_string(spread_ms));
      EXPECT_NEAR(timing.period.value, 1e-3 * period_ms, timing.period.plus_minus + 1e-9);
      // Uniform over `spread_ms`.
      const double jitter = 1e-3 * spread_ms / std::sqrt(12.0);
      EXPECT_NEAR(timing.jitter.value, jitter, 1.5 * timing.jitter.plus_minus + 1e-9);
      EXPECT_LE(timing.jitter.plus_minus, 0.1 * jitter + 2e-9);
      EXPECT_EQ(timing.missing, 0u);
      EXPECT_FALSE(timing.blurred);
    }
  }
}

TEST(ReportTiming, CountsMissingReports) {
  scene::ArmFile file = scene::load_arm("vintage_phantom").value();
  file.simulated.wire.loss = 0.1;
  const ReportTiming timing = timed(file);
  const double share =
      static_cast<double>(timing.missing) / static_cast<double>(timing.missing + timing.reports);
  EXPECT_NEAR(share, 0.1, 0.025);
  EXPECT_NEAR(timing.period.value, 1e-3, 1e-6);
}

TEST(ReportTiming, ReportsAmbiguityOfLateAndMissingReports) {
  scene::ArmFile file = scene::load_arm("vintage_phantom").value();
  file.simulated.wire.jitter_ns = 3'000'000;
  EXPECT_TRUE(timed(file).blurred);
  EXPECT_EQ(timing_of({0, 0.001, 0.002}).period.value, 0);
}

TEST(WatchdogTime, IsMeasuredOnAFreeTip) {
  int held = 0, all = 0;
  for (const double watchdog_ms : {100.0, 60.0, 130.0}) {
    if (!long_form() && watchdog_ms != 100) break;
    for (std::uint64_t seed = 1; seed <= (long_form() ? 10 : 1); ++seed) {
      HiddenArm arm = hidden_arm(seed);
      arm.file.simulated.firmware.watchdog_ns = static_cast<std::int64_t>(1e6 * watchdog_ms);
      const auto found = identified(arm, {.seconds = 12, .link = true, .seed = seed});
      ASSERT_TRUE(found.ok()) << found.error().message;
      ASSERT_TRUE(found->watchdog.has_value());
      if (!found->watchdog->known()) {
        // If the watchdog is later than the file says, a light arm has moved too far before.
        EXPECT_EQ(found->watchdog->last.end, WatchdogEnd::kStillOn);
        EXPECT_GT(watchdog_ms, 100);
        continue;
      }
      const Estimate& time = found->watchdog->time;
      std::printf("%g ms: %.2f +- %.2f ms\n", watchdog_ms, 1e3 * time.value, 1e3 * time.plus_minus);
      EXPECT_NEAR(1e3 * time.value, watchdog_ms, 2);
      held += time.holds(1e-3 * watchdog_ms) ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GE(held, 0.8 * all);
}

TEST(WatchdogTime, PushesStayWithinForceLimitAndWorkspace) {
  for (std::uint64_t seed = 1; seed <= (long_form() ? 40 : 4); ++seed) {
    support::Random random(seed);
    HiddenArm arm = hidden_arm(seed);
    scene::ArmFile& file = arm.file;
    file.simulated.hand = {};
    // The tip is next to the side towards which the first push goes, or the assumed friction is
    // wrong.
    Eigen::Vector3d p_W = file.workspace.middle();
    const bool near = seed % 2 == 0;
    if (near) p_W.y() = file.workspace.max_W.y() - random.uniform(0.001, 0.02);
    const double believed = random.uniform(0.5, 4) * file.simulated.plant.coulomb;
    file.simulated.firmware.watchdog_ns = 10'000'000'000;
    auto bench = BenchArm::open(file, {}, {}, {{0, p_W}}, kIdentifyForceMax);
    ASSERT_TRUE(bench.ok()) << bench.error().message;
    double most = 0, outside = 0;
    (*bench)->watch([&](const driver::TickRecord& tick) {
      const double force = Eigen::Vector3d(tick.f_wanted_W.data()).norm();
      most = std::max(most, force);
      const bool in = file.workspace.holds(Eigen::Vector3d(tick.p_WT.data()));
      outside = std::max(outside, in ? 0.0 : force);
    });
    const std::atomic<bool> never{false};
    const WatchdogTime found = watchdog_time(**bench,
                                             {.named = 0.1,
                                              .mass = file.simulated.plant.mass,
                                              .coulomb = believed,
                                              .delay = arm.delay,
                                              .workspace = file.workspace},
                                             file.limits.soft_start, never);
    EXPECT_FALSE(found.known());
    EXPECT_LE(most, kIdentifyForceMax);
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(found.last.end == WatchdogEnd::kNoRoom, near);
    EXPECT_TRUE((*bench)->device().zero_assured());
    // It was released at 15 mm; the rest of the motion is without force.
    const Eigen::Vector3d gone = (*bench)->device().state().p_WT - p_W;
    EXPECT_LT(gone.norm(), 0.03);
  }
}

TEST(WatchdogTime, ReportsWhyItIsUnknown) {
  const auto sentence_of = [](WatchdogEnd end) {
    Identified found;
    found.reports = ReportTiming{};
    found.watchdog.emplace();
    found.watchdog->last = {.end = end, .time = 0.15, .way = 0.015, .force = 0.1};
    for (const std::string& sentence : unidentified_parameters(found)) {
      if (sentence.find("Watchdog of the firmware: ") == 0) return sentence;
    }
    return std::string();
  };
  EXPECT_NE(sentence_of(WatchdogEnd::kStillOn).find("still on 150 ms"), std::string::npos);
  EXPECT_NE(sentence_of(WatchdogEnd::kAnswersOnly).find("only on request"), std::string::npos);
  EXPECT_NE(sentence_of(WatchdogEnd::kTooLong).find("feel-check"), std::string::npos);
  EXPECT_NE(sentence_of(WatchdogEnd::kNoRoom).find("side of the workspace"), std::string::npos);
}

}  // namespace
}  // namespace thimble::bringup
