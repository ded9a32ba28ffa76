#include "thimble/driver/heat_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "arms/hfab/hfab_report.h"
#include "support/random.h"
#include "support/vintage_arm.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_link.h"

namespace thimble::driver {
namespace {

constexpr HeatSettings kSettings{.continuous_current = {0.91, 1.07, 0.87},
                                 .time_constant = {60, 40, 90}};
constexpr double kLongestHold = 0.1;  // s

std::array<MotorDrive, 3> drives() {
  return support::vintage_model().drives;
}

HeatGuard guard(const HeatSettings& settings = kSettings) {
  return {settings, drives(), kLongestHold};
}

TEST(HeatGuard, MatchesTheClosedFormForAnyStep) {
  const std::array<std::int16_t, 3> mA{500, -700, 600};
  support::Random random(1);
  for (const bool jitter : {false, true}) {
    HeatGuard heat = guard();
    heat.sent(mA, false);
    double time = 0;
    while (time < 200) {
      const double dt = jitter ? random.uniform(1e-4, 3) : 0.5;
      heat.advance(dt);
      time += dt;
      for (std::size_t i = 0; i < 3; ++i) {
        const double end = std::pow(1e-3 * mA[i] / kSettings.continuous_current[i], 2);
        ASSERT_NEAR(heat.heat()[i], end * -std::expm1(-time / kSettings.time_constant[i]), 1e-12);
      }
    }
    heat.sent({}, false);
    const double before = heat.heat()[0];
    heat.advance(60);
    EXPECT_NEAR(heat.heat()[0], before * std::exp(-1), 1e-12)
        << "it cools with the same time constant";
  }
}

TEST(HeatGuard, FullDemandSettlesAtTheContinuousCurrent) {
  for (const double dt : {0.001, 0.0137, kLongestHold}) {
    for (const double time_constant : {1.0, 15.0, 60.0, 900.0}) {
      HeatGuard heat = guard({.continuous_current = kSettings.continuous_current,
                              .time_constant = {time_constant, time_constant, time_constant}});
      std::array<std::int16_t, 3> mA{};
      for (double time = 0; time < 3600; time += dt) {
        for (std::size_t i = 0; i < 3; ++i) {
          mA[i] = static_cast<std::int16_t>(std::lround(1e3 * heat.drives()[i].current_max));
        }
        heat.sent(mA, true);
        heat.advance(dt);
        for (std::size_t i = 0; i < 3; ++i) ASSERT_LE(heat.heat()[i], 1) << dt << ' ' << time;
      }
      EXPECT_GT(heat.lowered(), 0u);
      if (time_constant > 100) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(1e-3 * mA[i], kSettings.continuous_current[i], 0.0015);
      }
    }
  }
}

TEST(HeatGuard, LowersTheCurrentWithoutAStep) {
  HeatGuard heat = guard();
  double before = drives()[0].current_max, largest_step = 0;
  for (int tick = 0; tick < 200'000; ++tick) {
    const double most = heat.drives()[0].current_max;
    if (heat.heat()[0] < HeatGuard::kWarning - 0.001) {
      ASSERT_EQ(most, drives()[0].current_max);
    }
    largest_step = std::max(largest_step, before - most);
    before = most;
    heat.sent({static_cast<std::int16_t>(std::lround(1e3 * most)), 0, 0}, true);
    heat.advance(0.001);
  }
  EXPECT_LT(before, 0.92);
  EXPECT_LT(largest_step, 0.005) << "A per tick";
}

TEST(HeatGuard, AllowedCurrentIsBitIdenticalToItsFormula) {
  constexpr double kRounding = 0.0005;
  int full = 0, lowered = 0;
  for (int i = 0; i <= 4000; ++i) {
    HeatSettings settings = kSettings;
    // Densely around the warning level, where the current begins to fall.
    const double at = i < 2000 ? i / 2000.0 : 0.79 + 0.02 * (i - 2000) / 2000.0;
    settings.at_start = {at, at, at};
    const HeatGuard heat = guard(settings);
    for (std::size_t k = 0; k < 3; ++k) {
      const double arms = drives()[k].current_max, peak = arms / settings.continuous_current[k];
      const double hold = -std::expm1(-kLongestHold / settings.time_constant[k]);
      const double slope =
          std::min(std::max(0.0, (peak * peak - 1) / (1 - HeatGuard::kWarning)), 1 / hold - 1);
      const double most =
          settings.continuous_current[k] * std::sqrt(1 + slope * (1 - at)) - kRounding;
      ASSERT_EQ(heat.drives()[k].current_max, std::min(most, arms)) << at;
      ++(most < arms ? lowered : full);
    }
  }
  EXPECT_GT(full, 1000);
  EXPECT_GT(lowered, 1000);
}

TEST(HeatGuard, UnknownHeatIsHotAndInvalidTimeIsIgnored) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  HeatSettings settings = kSettings;
  settings.at_start = {nan, 1.5, -1};
  const HeatGuard hot = guard(settings);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(hot.heat()[i], 1);
    EXPECT_NEAR(hot.drives()[i].current_max, kSettings.continuous_current[i], 0.001);
  }
  settings.at_start = {0.5, 0.5, 0.5};
  HeatGuard heat = guard(settings);
  for (const double dt : {nan, -1.0, 0.0, std::numeric_limits<double>::infinity()}) {
    heat.advance(dt);
    EXPECT_EQ(heat.heat()[0], 0.5) << dt;
  }
}

TEST(HeatGuard, ActsForAnArmWhoseFirstMotorIsKnown) {
  EXPECT_TRUE(
      (HeatSettings{.continuous_current = {0.9, 0, 0}, .time_constant = {60, 60, 60}}.named()));
  EXPECT_FALSE(
      (HeatSettings{.continuous_current = {0, 0.9, 0.9}, .time_constant = {60, 60, 60}}.named()));
}

TEST(HeatGuard, CountsOnlyForcesLoweredByHeat) {
  HeatGuard heat = guard();
  heat.sent({3000, 3000, 3000}, true);  // cold: limited by the motors themselves
  EXPECT_EQ(heat.lowered(), 0u);
  for (int i = 0; i < 10'000; ++i) heat.advance(kLongestHold);
  heat.sent({500, 500, 500}, false);  // hot, but only a small force was requested
  EXPECT_EQ(heat.lowered(), 0u);
  heat.sent({500, 500, 500}, true);
  EXPECT_EQ(heat.lowered(), 1u);
}

/// Answers each read with a tip that moves to and fro by some counts of each encoder.
class OscillatingWire final : public Transport {
 public:
  explicit OscillatingWire(std::array<std::int16_t, 3>& mA) : mA_(mA) {}
  TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
    const auto count = static_cast<std::int16_t>(++reads_ % 2);
    const auto report = hfab::encode_input({.counts = {count, count, count}});
    std::copy(report.begin(), report.end(), buffer.begin());
    return {lost ? TransportStatus::kLost : TransportStatus::kOk, report.size(), 0};
  }
  TransportStatus write(std::span<const std::byte> report) noexcept override {
    if (lost) return TransportStatus::kLost;
    mA_ = hfab::decode_output(report)->current_mA;
    return TransportStatus::kOk;
  }

  bool lost = false;

 private:
  std::array<std::int16_t, 3>& mA_;
  int reads_ = 0;
};

TEST(HeatOfADevice, FiftyNewtonsFallToTheContinuousCurrent) {
  DeviceSettings settings = support::vintage_settings();
  settings.limits.force_max = 50;
  settings.heat = kSettings;
  std::array<std::int16_t, 3> mA{};
  auto opened = Device::open(
      std::make_unique<WireLink>(std::make_unique<OscillatingWire>(mA),
                                 std::make_unique<hfab::HfabArm>(support::vintage_model())),
      settings, 0);
  ASSERT_TRUE(opened) << opened.error().message;
  Device& device = **opened;
  ASSERT_TRUE(device.activate());
  const Eigen::Vector3d wanted(10, 40, -28);
  int most = 0;
  constexpr std::int64_t kLongPeriod_ns = 10'000'000;
  for (std::int64_t tick = 0; tick < 360'000; ++tick) {
    device.read(tick * kLongPeriod_ns, tick * kLongPeriod_ns);
    device.write({.f_T_W = wanted, .touch = {}});
    ASSERT_EQ(device.fault(), Fault::kNone);
    for (const double heat : device.heat().heat()) ASSERT_LE(heat, 1) << tick;
    for (const std::int16_t one : mA) most = std::max(most, std::abs(int{one}));
    if (tick > 100) {
      ASSERT_LT((device.f_sent_W().normalized() - wanted.normalized()).norm(), 1e-9);
    }
  }
  EXPECT_EQ(most, 3000) << "cold motors may use their full current";
  EXPECT_NEAR(device.heat().max_heat(), 1, 0.01);
  double warmest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    warmest = std::max(warmest, 1e-3 * std::abs(mA[i]) / kSettings.continuous_current[i]);
  }
  EXPECT_NEAR(warmest, 1, 0.003)
      << "the motor with the largest demand is at its continuous current";
  EXPECT_GT(device.heat().lowered(), 300'000u);
  // It cools while it is idle, and then the full current is available again.
  device.deactivate();
  for (std::int64_t tick = 360'000; tick < 420'000; ++tick) {
    device.read(tick * kLongPeriod_ns, tick * kLongPeriod_ns);
    device.write({});
  }
  EXPECT_LT(*std::max_element(device.heat().heat().begin(), device.heat().heat().end()), 0.01);
}

TEST(HeatOfADevice, CoolsOnceTheArmIsGone) {
  DeviceSettings settings = support::vintage_settings();
  settings.heat = kSettings;
  std::array<std::int16_t, 3> mA{};
  auto wire = std::make_unique<OscillatingWire>(mA);
  OscillatingWire& far = *wire;
  auto opened =
      Device::open(std::make_unique<WireLink>(
                       std::move(wire), std::make_unique<hfab::HfabArm>(support::vintage_model())),
                   settings, 0);
  ASSERT_TRUE(opened) << opened.error().message;
  Device& device = **opened;
  ASSERT_TRUE(device.activate());
  std::int64_t now_ns = 0;
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      now_ns += 10'000'000;
      device.read(now_ns, now_ns);
      device.write({.f_T_W = {0, 4, 0}, .touch = {}});
    }
    return *std::max_element(device.heat().heat().begin(), device.heat().heat().end());
  };
  const double warm = run(2000);
  EXPECT_GT(warm, 0.01);
  far.lost = true;
  EXPECT_LT(run(1000), warm);
}

TEST(HeatOfADevice, RefusesAnInvalidTimeConstant) {
  DeviceSettings settings = support::vintage_settings();
  settings.heat = kSettings;
  settings.heat.time_constant[1] = 0;
  std::array<std::int16_t, 3> mA{};
  const auto opened = Device::open(
      std::make_unique<WireLink>(std::make_unique<OscillatingWire>(mA),
                                 std::make_unique<hfab::HfabArm>(support::vintage_model())),
      settings, 0);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("thermal_time_constant"), std::string::npos);
}

}  // namespace
}  // namespace thimble::driver
