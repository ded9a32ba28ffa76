#include "view/input/hand_input.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "view/input/space_mouse.h"

namespace thimble::view {
namespace {

using Eigen::Vector3d;

/// A report of 16-bit numbers after its own number.
std::vector<std::byte> report(int id, const std::vector<int>& counts) {
  std::vector<std::byte> bytes{static_cast<std::byte>(id)};
  for (const int count : counts) {
    const auto bits = static_cast<std::uint16_t>(count);
    bytes.push_back(static_cast<std::byte>(bits & 0xffU));
    bytes.push_back(static_cast<std::byte>(bits >> 8U));
  }
  return bytes;
}

TEST(SpaceMouseReport, ParsesTranslationAndRotation) {
  SpaceMouseState apart;
  EXPECT_TRUE(take_space_mouse_report(report(1, {10, -20, 350}), apart));
  EXPECT_TRUE(take_space_mouse_report(report(2, {-350, 5, 256}), apart));
  EXPECT_EQ(apart.translation, (std::array<std::int16_t, 3>{10, -20, 350}));
  EXPECT_EQ(apart.rotation, (std::array<std::int16_t, 3>{-350, 5, 256}));
  SpaceMouseState together;
  EXPECT_TRUE(take_space_mouse_report(report(1, {10, -20, 350, -350, 5, 256}), together));
  EXPECT_EQ(together, apart);
}

TEST(SpaceMouseReport, KeepsRotationIfOnlyTranslationIsReported) {
  SpaceMouseState state;
  take_space_mouse_report(report(1, {1, 2, 3, 4, 5, 6}), state);
  take_space_mouse_report(report(1, {7, 8, 9}), state);
  EXPECT_EQ(state.rotation, (std::array<std::int16_t, 3>{4, 5, 6}));
  EXPECT_EQ(state.translation, (std::array<std::int16_t, 3>{7, 8, 9}));
}

TEST(SpaceMouseReport, ParsesButtonsOfOneToFourBytes) {
  SpaceMouseState state;
  EXPECT_TRUE(take_space_mouse_report(report(3, {0x0102}), state));
  EXPECT_EQ(state.buttons, 0x0102U);
  EXPECT_TRUE(take_space_mouse_report(report(3, {1, 0x8000, 0x7777}), state));
  EXPECT_EQ(state.buttons, 0x80000001U);
  const std::array one{std::byte{3}, std::byte{2}};
  EXPECT_TRUE(take_space_mouse_report(one, state));
  EXPECT_EQ(state.buttons, 2U);
}

TEST(SpaceMouseReport, KeepsStateForIncompleteOrUnknownReports) {
  SpaceMouseState state;
  take_space_mouse_report(report(1, {1, 2, 3}), state);
  const SpaceMouseState before = state;
  for (const auto& bytes :
       {std::vector<std::byte>{}, report(1, {}), report(1, {5, 6}), report(2, {5, 6}),
        report(3, {}), report(0, {5, 6, 7}), report(0x17, {100})}) {
    EXPECT_FALSE(take_space_mouse_report(bytes, state)) << bytes.size();
    EXPECT_EQ(state, before);
  }
}

TEST(SpaceMouse, IsIdentifiedByIdsAndUsage) {
  EXPECT_TRUE(is_space_mouse(0x046d, 0xc62b, 1, 8));
  EXPECT_TRUE(is_space_mouse(0x256f, 0xc635, 1, 8));
  EXPECT_TRUE(is_space_mouse(0x256f, 0xc635, 0, 0)) << "a system that reports no usage";
  EXPECT_FALSE(is_space_mouse(0x256f, 0xc652, 1, 2)) << "the mouse of a receiver";
  EXPECT_FALSE(is_space_mouse(0x046d, 0xc52b, 1, 8)) << "another receiver of Logitech";
}

TEST(HandPush, KeysPushAlongViewAxes) {
  EXPECT_EQ(push_of(HandKeys{.right = true, .up = true}).share, Vector3d(1, 1, 0));
  EXPECT_EQ(push_of(HandKeys{.farther = true}).share, Vector3d(0, 0, -1));
  EXPECT_FALSE(push_of(HandKeys{.left = true, .right = true}).any());
  EXPECT_TRUE(push_of(HandKeys{.slow = true}).slow);
}

TEST(HandPush, StickStartsAtZeroAtDeadZone) {
  EXPECT_FALSE(push_of(GamepadState{}).any());
  for (int i = 0; i < 16; ++i) {
    const double angle = 0.4 * i;
    const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
    EXPECT_FALSE(push_of(GamepadState{.left = 0.99 * kStickDeadZone * way}).any());
    const Vector3d little = push_of(GamepadState{.left = 1.01 * kStickDeadZone * way}).share;
    EXPECT_GT(little.norm(), 0);
    EXPECT_LT(little.norm(), 0.01);
    const Vector3d full = push_of(GamepadState{.left = way}).share;
    EXPECT_NEAR((full - Vector3d(way.x(), -way.y(), 0)).norm(), 0, 1e-12);
  }
  EXPECT_NEAR(push_of(GamepadState{.left = {1, 1}}).share.norm(), 1, 1e-12)
      << "a corner is not larger";
}

TEST(HandPush, TriggersPushAwayAndNear) {
  EXPECT_NEAR(push_of(GamepadState{.right_trigger = 1}).share.z(), -1, 1e-12);
  EXPECT_NEAR(push_of(GamepadState{.left_trigger = 1}).share.z(), 1, 1e-12);
  EXPECT_FALSE(push_of(GamepadState{.left_trigger = -0.8}).any());
  EXPECT_FALSE(push_of(GamepadState{.left_trigger = 0.5, .right_trigger = 0.5}).any());
  EXPECT_FALSE(push_of(GamepadState{.left_trigger = std::nan(""), .right_trigger = -1}).any());
}

TEST(HandPush, CapPushesInItsDirection) {
  EXPECT_NEAR(
      (push_of(SpaceMouseState{.translation = {350, 0, 0}}).share - Vector3d(1, 0, 0)).norm(), 0,
      1e-12);
  EXPECT_NEAR(
      (push_of(SpaceMouseState{.translation = {0, 350, 0}}).share - Vector3d(0, 0, 1)).norm(), 0,
      1e-12);
  EXPECT_NEAR(
      (push_of(SpaceMouseState{.translation = {0, 0, 350}}).share - Vector3d(0, -1, 0)).norm(), 0,
      1e-12);
  EXPECT_FALSE(push_of(SpaceMouseState{.translation = {8, -8, 8}}).any());
  EXPECT_LE(push_of(SpaceMouseState{.translation = {-32768, 32767, 500}}).share.norm(), 1 + 1e-12);
  EXPECT_TRUE(push_of(SpaceMouseState{.buttons = 1}).slow);
  EXPECT_TRUE(push_of(SpaceMouseState{.buttons = 2}).let_go);
}

class HandInputTest : public ::testing::Test {
 protected:
  void push(const Vector3d& share, double dt = 0.01) {
    input_.step({.share = share}, camera_, p_WT_, reach_, dt);
  }

  HandInput input_;
  Camera camera_{.yaw = 0, .pitch = 0};  // looks along -x: right is y, up is z
  Vector3d p_WT_{0, 0.01, 0.02};
  Eigen::AlignedBox3d reach_{Vector3d(-0.1, -0.03, -0.1), Vector3d(0.1, 0.1, 0.1)};
};

TEST_F(HandInputTest, HoldsTheHandAtTheTip) {
  push({0, 0, 0});
  EXPECT_FALSE(input_.holds());
  push({1, 0, 0});
  EXPECT_TRUE(input_.holds());
  const double way = 0.01 * input_.speed();
  EXPECT_NEAR((input_.hand().p_WH - (p_WT_ + Vector3d(0, way, 0))).norm(), 0, 1e-12);
  push({0, 0, 0});
  EXPECT_TRUE(input_.holds()) << "it keeps its position";
  push({0, -1, 1});
  EXPECT_NEAR((input_.hand().p_WH - (p_WT_ + Vector3d(way, way, -way))).norm(), 0, 1e-12);
}

TEST_F(HandInputTest, ReleasesOnRequestAndOnSourceChange) {
  push({1, 0, 0});
  const Vector3d held = input_.hand().p_WH;
  input_.step({.share = {1, 0, 0}, .let_go = true}, camera_, p_WT_, reach_, 0.01);
  EXPECT_FALSE(input_.holds());
  EXPECT_EQ(input_.hand().p_WH, held);
  push({1, 0, 0});
  EXPECT_TRUE(input_.holds());
  input_.choose(HandSource::kGamepad);
  EXPECT_FALSE(input_.holds());
}

TEST_F(HandInputTest, StaysNearTheTipAndInTheWorkspace) {
  for (int i = 0; i < 1000; ++i) push({-1, 0, -1});
  EXPECT_NEAR((input_.hand().p_WH - p_WT_).norm(), HandInput::kLeash, 0.015);
  EXPECT_GE(input_.hand().p_WH.y(), -0.03);
  // The way out of a wall begins at once.
  const Vector3d far = input_.hand().p_WH;
  push({1, 0, 1});
  EXPECT_LT((input_.hand().p_WH - p_WT_).norm(), (far - p_WT_).norm());
}

TEST_F(HandInputTest, SlowFrameDoesNotMoveFarther) {
  push({0, 1, 0}, 1000);
  EXPECT_NEAR((input_.hand().p_WH - p_WT_).norm(), HandInput::kFrameMax * input_.speed(), 1e-12);
}

TEST_F(HandInputTest, IgnoresNaN) {
  push({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_FALSE(input_.holds());
}

TEST_F(HandInputTest, SpeedIsLimitedAndSlowIsAFifth) {
  for (int i = 0; i < 20; ++i) input_.change_speed(true);
  EXPECT_EQ(input_.speed(), HandInput::kSpeeds.back());
  input_.step({.share = {0, 1, 0}, .slow = true}, camera_, p_WT_, reach_, 0.01);
  EXPECT_NEAR((input_.hand().p_WH - p_WT_).norm(), 0.01 * 0.2 * HandInput::kSpeeds.back(), 1e-12);
  for (int i = 0; i < 20; ++i) input_.change_speed(false);
  EXPECT_EQ(input_.speed(), HandInput::kSpeeds.front());
}

TEST(HandSources, MatchTheirNames) {
  EXPECT_EQ(hand_source_named("spacemouse"), HandSource::kSpaceMouse);
  EXPECT_EQ(hand_source_named("keyboard"), HandSource::kKeyboard);
  EXPECT_EQ(hand_source_named("nose"), std::nullopt);
}

}  // namespace
}  // namespace thimble::view
