#include "surface/contact_transient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "thimble/render/effect/map_settings.h"

namespace thimble::render {
namespace {

constexpr double kPeriod = 1e-3;  // s

/// Presses on a plane at a constant speed (m/s) and returns the normal force without the spring's
/// part in each tick, N. `pressure`: force of the spring, N.
std::vector<double> tap(ContactTransient& effect, double speed, double pressure, int ticks) {
  std::vector<double> forces;
  driver::DeviceState state;
  state.dt = kPeriod;
  state.v_WT = {0.3, 0, -speed};
  for (int tick = 0; tick < ticks; ++tick) {
    SurfaceResponse response;
    response.contact = {.touching = true, .triangle = 0, .depth = 0.001, .n_W = {0, 0, 1}};
    response.f_T_W = {0.1, 0, pressure};
    effect.touch(state, response);
    EXPECT_EQ(response.f_T_W.x(), 0.1);
    forces.push_back(response.f_T_W.z() - pressure);
  }
  return forces;
}

ContactTransient transient(double gain = 10) {
  return ContactTransient({.gain = gain, .frequency = 100, .decay = 0.02}, {.tick = kPeriod});
}

TEST(ContactTransient, IsADecayingSineFromTheFirstTick) {
  ContactTransient effect = transient();
  const auto forces = tap(effect, 0.1, 5, 50);
  for (std::size_t tick = 0; tick < forces.size(); ++tick) {
    const double t = kPeriod * (static_cast<double>(tick) + 0.5);
    EXPECT_NEAR(forces[tick], std::exp(-t / 0.02) * std::sin(2 * std::numbers::pi * 100 * t),
                1e-12);
  }
}

TEST(ContactTransient, GrowsWithTheSpeedOfTheTip) {
  ContactTransient slow = transient(), fast = transient();
  const auto weak = tap(slow, 0.05, 5, 20), strong = tap(fast, 0.1, 5, 20);
  for (std::size_t tick = 0; tick < weak.size(); ++tick) {
    EXPECT_NEAR(2 * weak[tick], strong[tick], 1e-15);
  }
}

TEST(ContactTransient, NeverPullsTheTipIntoTheSurface) {
  ContactTransient effect = transient(50);
  for (const double force : tap(effect, 0.3, 0.2, 50)) EXPECT_GE(force, -0.2);
}

TEST(ContactTransient, BeginsOncePerContact) {
  ContactTransient effect = transient();
  tap(effect, 0.1, 5, 400);
  for (const double force : tap(effect, 0.2, 5, 20)) EXPECT_EQ(force, 0);
  effect.leave();
  EXPECT_GT(tap(effect, 0.2, 5, 2)[1], 0.5);
}

TEST(ContactTransient, ATipThatLeavesOrHasNoSpeedFeelsNone) {
  for (const double speed : {0.0, -0.1, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    ContactTransient effect = transient();
    for (const double force : tap(effect, speed, 5, 20)) EXPECT_EQ(force, 0) << speed;
  }
}

TEST(ContactTransient, RefusesAFrequencyThatTheLoopCannotRender) {
  for (const double frequency : {251.0, 250.0}) {
    ContactTransient::Settings settings;
    MapSettings reader({{"frequency", frequency}});
    settings.read(reader, {.tick = kPeriod});
    EXPECT_EQ(reader.mistakes().empty(), frequency == 250) << frequency;
  }
}

}  // namespace
}  // namespace thimble::render
