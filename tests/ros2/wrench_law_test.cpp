// Forces received by a topic, tick by tick: limits, maximum age, and refused messages.
#include "ros2/wrench_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ros2/message_check.h"
#include "ros2/ros_option_strings.h"

namespace thimble::ros2 {
namespace {

constexpr driver::GateLimits kLimits{.force_max = 3,
                                     .speed_max = 1,
                                     .rise_max = 1e4,
                                     .soft_start = 0.1,
                                     .reopen = 0.04,
                                     .stall_ns = 20'000'000,
                                     .watchdog_ns = 200'000'000};

/// A law with a scene whose force is 1 N upwards, ticked every millisecond.
struct Rig {
  explicit Rig(RosOptions options) : law(channel, driver::ForceLaw(scene), options, kLimits) {}

  /// Requests a force that arrives at the start of the next tick.
  void ask(double x, double y = 0, double z = 0) {
    channel.wrench.store({++number, time_ns + 1'000'000, answers_ns, {x, y, z}});
  }
  Eigen::Vector3d tick(int ticks = 1) {
    Eigen::Vector3d f_W{0, 0, 0};
    for (int i = 0; i < ticks; ++i) {
      driver::DeviceState state;
      state.dt = 0.001;
      state.time_ns = time_ns += 1'000'000;
      const driver::ForceCommand command = law(state);
      f_W = command.f_T_W;
      touching = command.touch.in_contact;
    }
    return f_W;
  }
  /// Requests a force of `x` (N) in each of `ticks` ticks.
  Eigen::Vector3d hold(double x, int ticks) {
    Eigen::Vector3d f_W{0, 0, 0};
    for (int i = 0; i < ticks; ++i) {
      ask(x);
      f_W = tick();
    }
    return f_W;
  }

  struct Scene {
    driver::ForceCommand operator()(const driver::DeviceState&) noexcept {
      driver::ForceCommand command;
      command.f_T_W = {0, 0, 1};
      command.touch.in_contact = true;
      command.touch.depth = 0.002;
      return command;
    }
  } scene;
  RosChannel channel;
  WrenchLaw law;
  std::uint64_t number = 0;
  std::int64_t time_ns = 0;
  std::int64_t answers_ns = 0;  // stamp of the requested force
  bool touching = false;        // contact as the last tick reported it to the gate
};

TEST(WrenchLaw, MeasuresTheAgeOfAnsweredPositions) {
  Rig rig({.force = RosForce::kAdd});
  for (int i = 0; i < 100; ++i) {
    // Requested between two ticks, for a position read 3 ms before the tick that takes the force.
    rig.answers_ns = i < 10 ? 0 : rig.time_ns - 2'000'000;
    rig.ask(1);
    rig.tick(1);
  }
  EXPECT_EQ(rig.law.ages().count(), 90U) << "forces without a stamp are not counted";
  EXPECT_NEAR(rig.law.ages().percentile(0.5), 3e6, 3e3);
  rig.answers_ns = rig.time_ns + 1'000'000'000;
  rig.ask(1);
  rig.tick(1);
  EXPECT_EQ(rig.law.ages().count(), 90U) << "a stamp in the future belongs to another clock";
}

TEST(WrenchLaw, AddsToOrReplacesTheForceOfTheScene) {
  Rig add({.force = RosForce::kAdd});
  EXPECT_EQ(add.tick(), Eigen::Vector3d(0, 0, 1));
  EXPECT_TRUE(add.hold(2, 200).isApprox(Eigen::Vector3d(2, 0, 1)));
  EXPECT_TRUE(add.touching);
  Rig replace({.force = RosForce::kReplace});
  EXPECT_EQ(replace.tick(), Eigen::Vector3d(0, 0, 0));
  EXPECT_TRUE(replace.hold(2, 200).isApprox(Eigen::Vector3d(2, 0, 0)));
  EXPECT_FALSE(replace.touching) << "replaced springs store no energy";
}

TEST(WrenchLaw, FirstForceRisesWithinTheSoftStart) {
  Rig rig({.force = RosForce::kReplace});
  EXPECT_NEAR(rig.hold(2, 50).x(), 1.0, 1e-9);
  EXPECT_NEAR(rig.hold(2, 50).x(), 2.0, 1e-9);
}

TEST(WrenchLaw, ForceWithoutRenewalBecomesZeroAndReopens) {
  Rig rig({.force = RosForce::kReplace});
  rig.hold(2, 200);
  EXPECT_NEAR(rig.tick(50).x(), 2.0, 1e-9);
  EXPECT_EQ(rig.tick(1).x(), 0.0);
  EXPECT_EQ(rig.law.stalls(), 1U);
  // 51 ms is less than the arm's watchdog: back within reopen, 40 ms.
  EXPECT_NEAR(rig.hold(2, 20).x(), 1.0, 1e-9);
  EXPECT_NEAR(rig.hold(2, 20).x(), 2.0, 1e-9);
  rig.tick(300);
  EXPECT_NEAR(rig.hold(2, 50).x(), 1.0, 1e-9);  // longer: within soft_start
}

TEST(WrenchLaw, AgeOfAForceCountsFromItsArrival) {
  Rig rig({.force = RosForce::kReplace});
  rig.hold(2, 200);
  // It arrived 30 ms before the loop continued.
  rig.ask(2);
  rig.time_ns += 30'000'000;
  EXPECT_NEAR(rig.tick(21).x(), 2.0, 1e-9);
  EXPECT_EQ(rig.tick(1).x(), 0.0);
  // A force that arrived too long ago is ignored.
  rig.ask(2);
  rig.time_ns += 60'000'000;
  EXPECT_EQ(rig.tick(60).x(), 0.0);
  EXPECT_EQ(rig.law.stalls(), 1U);
}

TEST(WrenchLaw, LimitsAnyForce) {
  Rig own({.force = RosForce::kReplace, .force_limit = 1.5});
  EXPECT_NEAR(own.hold(-2, 200).x(), -1.5, 1e-9);
  EXPECT_EQ(own.law.cut(), 200U);
  // A limit above the arm's is reduced to it.
  Rig arms({.force = RosForce::kReplace, .force_limit = 100});
  EXPECT_NEAR(arms.hold(50, 200).x(), 3.0, 1e-9);
  EXPECT_NEAR(arms.hold(std::numeric_limits<double>::max(), 1).x(), 3.0, 1e-9);
}

TEST(WrenchCheck, ReturnsTheProblem) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(check_message({1, 2, 3}, {0, 0, 0}, "world", "world"), MessageVerdict::kGood);
  EXPECT_EQ(check_message({1, 2, 3}, {0, 0, 0}, "", "world"), MessageVerdict::kGood);
  EXPECT_EQ(check_message({1, 2, 3}, {0, 0, 0}, "/world", "world"), MessageVerdict::kGood);
  EXPECT_EQ(check_message({1, 2, 3}, {0, 0, 0}, "tip", "world"), MessageVerdict::kWrongFrame);
  EXPECT_EQ(check_message({1, kNan, 3}, {0, 0, 0}, "world", "world"), MessageVerdict::kNotFinite);
  EXPECT_EQ(check_message({1, 2, 3}, {0, 0, kInf}, "world", "world"), MessageVerdict::kNotFinite);
}

TEST(RosOptionStrings, RefuseInvalidOptions) {
  EXPECT_TRUE(ros_options({}));
  EXPECT_TRUE(ros_options({.name_space = "/lab/phantom_1"}));
  for (const char* bad : {"phantom", "/", "/phantom/", "/1st", "/a b", "/a//b", "/ä"}) {
    EXPECT_FALSE(ros_options({.name_space = bad})) << bad;
  }
  for (const char* bad : {"tip,tip", "world", "world,", ",tip"}) {
    EXPECT_FALSE(ros_options({.frames = bad})) << bad;
  }
  EXPECT_FALSE(ros_options({.names = "omnis"}));
  EXPECT_FALSE(ros_options({.force = "all"}));
  EXPECT_FALSE(ros_options({.domain = 233}));
  EXPECT_FALSE(ros_options({.stale_ms = 0.5}));
  EXPECT_FALSE(ros_options({.stale_ms = 2000}));
  EXPECT_FALSE(ros_options({.force_limit = -1}));
  EXPECT_FALSE(ros_options({.force_limit = std::numeric_limits<double>::quiet_NaN()}));
}

TEST(RosOptionStrings, SetTheOptions) {
  const auto omni = ros_options({.names = "omni", .force = "replace", .frames = "map,stylus"});
  ASSERT_TRUE(omni);
  EXPECT_EQ(omni->style, RosStyle::kOmni);
  EXPECT_EQ(omni->name_space, "/phantom") << "the namespace of the Omni's drivers";
  EXPECT_EQ(omni->force, RosForce::kReplace);
  EXPECT_EQ(omni->world_frame, "map");
  EXPECT_EQ(omni->tip_frame, "stylus");
  EXPECT_EQ(omni->stale_ns, 50'000'000);
  EXPECT_EQ(ros_options({.stale_ms = 20})->stale_ns, 20'000'000);
}

}  // namespace
}  // namespace thimble::ros2
