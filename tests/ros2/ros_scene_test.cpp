// Several arms of one run in one domain: names that must differ do differ.
#include "ros2/ros_scene.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>
#include <vector>

namespace thimble::ros2 {
namespace {

std::vector<std::string> links_of(const std::string& urdf) {
  std::vector<std::string> links;
  const std::regex link("<link name=\"([^\"]*)\"");
  for (auto one = std::sregex_iterator(urdf.begin(), urdf.end(), link);
       one != std::sregex_iterator(); ++one) {
    links.push_back((*one)[1].str());
  }
  return links;
}

TEST(RosScene, TwoArmsOfOneKindHaveDifferentNames) {
  auto session = session::Session::open("two_hands", {.several_arms = true});
  ASSERT_TRUE(session) << session.error().message;
  const RosOptions options;
  const RosScene left = ros_scene(**session, options, 0), right = ros_scene(**session, options, 1);
  EXPECT_EQ(left.arm, "left (vintage_phantom)");
  EXPECT_EQ(right.arm, "right (vintage_phantom)");
  EXPECT_NE(left.urdf.find("<robot name=\"left_vintage_phantom\">"), std::string::npos);
  const auto left_links = links_of(left.urdf), right_links = links_of(right.urdf);
  ASSERT_GT(left_links.size(), 4U);
  const std::set<std::string> of_left(left_links.begin(), left_links.end());
  for (const std::string& link : right_links) {
    if (link == options.world_frame) continue;  // shared by both
    EXPECT_EQ(of_left.count(link), 0U) << link;
    EXPECT_EQ(link.rfind("right_", 0), 0U) << link;
    EXPECT_NE(link, "right_tip") << "which /tf has";
  }
}

TEST(RosScene, AllBodiesThatMeetMove) {
  auto session = session::Session::open("dominoes");
  ASSERT_TRUE(session) << session.error().message;
  const RosScene scene = ros_scene(**session, {}, 0);
  ASSERT_EQ(scene.objects.size(), 9U);
  EXPECT_FALSE(scene.objects[0].moves) << "the table";
  for (std::size_t i = 1; i < scene.objects.size(); ++i) {
    EXPECT_TRUE(scene.objects[i].moves) << i;
    EXPECT_EQ(scene.objects[i].corners_B.size(), 36U) << i;
  }
}

TEST(RosScene, OneArmKeepsTheNameOfItsFile) {
  auto session = session::Session::open("box");
  ASSERT_TRUE(session) << session.error().message;
  const RosScene scene = ros_scene(**session, {}, 0);
  EXPECT_EQ(scene.arm, "vintage_phantom");
  EXPECT_NE(scene.urdf.find("\"vintage_phantom_base\""), std::string::npos);
}

}  // namespace
}  // namespace thimble::ros2
