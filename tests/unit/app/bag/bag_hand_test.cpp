#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bag/write_bag.h"
#include "hand/bag_hand.h"
#include "support/scratch.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

/// Position of a hand that oscillates at 2 Hz, m.
Eigen::Vector3d sway(double time) {
  return {0.01 * std::sin(4 * M_PI * time), 0.02 * time, 0.005 * std::cos(4 * M_PI * time)};
}

TEST(BagHand, FollowsADenseBagWithin10Micrometres) {
  const fs::path bag = support::scratch_folder() / "thimble_bag_hand";
  fs::remove_all(bag);
  bag::BagTrack poses;
  poses.name = "/pose";
  for (int i = 0; i <= 2005; ++i) {
    poses.messages.push_back({.time_ns = 1'000'000 * i, .value = sway(0.001 * i)});
  }
  ASSERT_TRUE(bag::write_bag(bag, {poses}));
  const auto stations = read_bag_hand(bag, "/pose", bag::BagAxes::kPlain);
  ASSERT_TRUE(stations) << stations.error().message;
  // Every tenth sample, and the last.
  EXPECT_EQ(stations->size(), 202U);
  EXPECT_DOUBLE_EQ(stations->back().time, 2.005);
  EXPECT_EQ(stations->back().p_W, poses.messages.back().value);
  const auto route = plan_hand(*stations, {});
  ASSERT_TRUE(route) << route.error().message;
  double most = 0;
  for (const auto& [time, p_W] : *route) {
    if (time < 0.01 || time > 1.99) continue;  // a hand starts and ends at rest
    most = std::max(most, (p_W - sway(time)).norm());
  }
  EXPECT_LT(most, 1e-5);
  const auto turned = read_bag_hand(bag, {}, bag::BagAxes::kOmni);
  ASSERT_TRUE(turned);
  EXPECT_EQ(turned->at(5).p_W.y(), stations->at(5).p_W.x());
  fs::remove_all(bag);
}

TEST(BagHand, RejectsPositionsThatAreNotInMetres) {
  const fs::path bag = support::scratch_folder() / "thimble_bag_hand_far";
  fs::remove_all(bag);
  bag::BagTrack poses;
  poses.name = "/pose";
  poses.messages.push_back({.time_ns = 0, .value = {20, 30, 40}});
  ASSERT_TRUE(bag::write_bag(bag, {poses}));
  const auto hand = read_bag_hand(bag, {}, bag::BagAxes::kPlain);
  ASSERT_FALSE(hand);
  EXPECT_NE(hand.error().message.find("within 2 m"), std::string::npos) << hand.error().message;
  fs::remove_all(bag);
}

}  // namespace
}  // namespace thimble::scene
