// Names, axes and joints of the styles of topics.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <atomic>
#include <chrono>
#include <numbers>
#include <thread>
#include <vector>

#include "ros2/ros_names.h"
#include "ros2/ros_steps.h"

namespace thimble::ros2 {
namespace {

constexpr RosStyle kAll[] = {RosStyle::kPlain, RosStyle::kCrtk, RosStyle::kOmni};

TEST(RosNames, ConvertVectorsBothWaysInEveryStyle) {
  const std::array<double, 3> v{0.1, -0.2, 0.3};
  for (const RosStyle style : kAll) EXPECT_EQ(from_style(style, to_style(style, v)), v);
  EXPECT_EQ(to_style(RosStyle::kPlain, v), v);
}

TEST(RosNames, OmniStyleHasTheAxesOfTheOmniDrivers) {
  // World: x to the user, y to the right, z up. Omni: x right, y away from the user, z up.
  using V = std::array<double, 3>;
  EXPECT_EQ(to_style(RosStyle::kOmni, V{1, 0, 0}), (V{0, -1, 0}));
  EXPECT_EQ(to_style(RosStyle::kOmni, V{0, 1, 0}), (V{1, 0, 0}));
  EXPECT_EQ(to_style(RosStyle::kOmni, V{0, 0, 1}), (V{0, 0, 1}));
}

TEST(RosNames, RotationsConvertLikeVectors) {
  const Eigen::Quaterniond q_WT = Eigen::Quaterniond(0.5, 0.1, -0.7, 0.3).normalized();
  const Eigen::Vector3d v_T(0.3, 0.4, -0.2);
  const Eigen::Vector3d v_W = q_WT * v_T;
  for (const RosStyle style : kAll) {
    const auto q = to_style(style, std::array<double, 4>{q_WT.w(), q_WT.x(), q_WT.y(), q_WT.z()});
    const Eigen::Vector3d turned = Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * v_T;
    const auto expected = to_style(style, std::array<double, 3>{v_W.x(), v_W.y(), v_W.z()});
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(turned[i], expected[static_cast<std::size_t>(i)], 1e-15);
    }
  }
}

TEST(RosNames, OmniJointsHaveTheOffsetsOfTheOmniDrivers) {
  const std::array<double, 6> angles =
      joint_angles(RosStyle::kOmni, {0.1, 0.2, 0.7}, {0.25F, 0.5F, 0.75F});
  const double pi = std::numbers::pi;
  const std::array<double, 6> expected{-0.1, 0.2, 0.5, pi - 0.25, -0.75 * pi - 0.5, -pi - 0.75};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_DOUBLE_EQ(angles[i], expected[i]);
  EXPECT_EQ(joint_names(RosStyle::kOmni, 3),
            (std::vector<std::string>{"waist", "shoulder", "elbow"}));
  EXPECT_EQ(joint_names(RosStyle::kPlain, 6).back(), "gimbal3");
}

TEST(RosNames, ConvertAnyNameToAValidFrame) {
  EXPECT_EQ(frame_name_of("the ball-1"), "the_ball_1");
  EXPECT_EQ(frame_name_of(""), "_");
}

TEST(RosNames, EachObjectHasItsOwnFrame) {
  EXPECT_EQ(object_frames({"can 1", "can-1", "ball", "can_1", "can_1_2"}),
            (std::vector<std::string>{"object_can_1", "object_can_1_2", "object_ball",
                                      "object_can_1_3", "object_can_1_2_2"}));
}

TEST(SteppedClock, WaitsForPermits) {
  std::atomic<bool> stop{false};
  SteppedClock clock(stop);
  EXPECT_FALSE(clock.steps().wait_for_permit(std::chrono::milliseconds(0)));
  EXPECT_TRUE(clock.steps().idle());
  std::vector<std::int64_t> times;
  std::thread loop([&] {
    for (int tick = 0; !stop.load(); ++tick) {
      clock.sleep_until_ns(1'000'000 * tick);
      if (stop.load()) return;
      times.push_back(clock.now_ns());
      clock.steps().done(static_cast<std::uint64_t>(tick) + 1);
    }
  });
  for (const std::uint64_t all : {3U, 10U}) {
    clock.steps().permit(all);
    clock.steps().permit(2);  // without effect: these ticks are already done
    std::uint64_t done = 0;
    while (done < all) done = clock.steps().wait_for_ticks(std::chrono::milliseconds(100));
    EXPECT_EQ(done, all);
    EXPECT_TRUE(clock.steps().idle());
    EXPECT_EQ(times.size(), all);
    EXPECT_EQ(times.back(), 1'000'000 * (static_cast<std::int64_t>(all) - 1));
  }
  stop.store(true);
  loop.join();
  EXPECT_EQ(times.size(), 10U);
}

TEST(RosSteps, CompleteAfterTheTopicsOfAllArms) {
  RosSteps steps;
  steps.expect(2);
  steps.permit(5);
  steps.done(5);
  steps.set_published(0, 5);
  EXPECT_FALSE(steps.all_published(5));
  steps.set_published(1, 4);
  EXPECT_FALSE(steps.all_published(5));
  steps.set_published(1, 5);
  EXPECT_TRUE(steps.all_published(5));
}

}  // namespace
}  // namespace thimble::ros2
