#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "figures/lost_contacts.h"
#include "support/covered.h"
#include "support/meshes/elephant.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/scene_touch.h"

// The demo's stroke with every contact setting of a scene, through the complete chain.

namespace thimble {
namespace {

/// Opens the demo's scene with a `contact:` section; the error is empty on success.
std::unique_ptr<session::Session> open_with(const std::string& contact, std::string& error) {
  return support::open_elephant_text(support::elephant_text(contact), &error);
}

class EveryWayOfContact : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryWayOfContact, TouchesTheElephantWithoutLostContact) {
  THIMBLE_NEEDS_MESHES();
  std::string error;
  const auto session = open_with(GetParam(), error);
  ASSERT_TRUE(session) << error;
  ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  EXPECT_EQ(session::count_lost_contacts(session->ticks(), session->touch()), 0u);
  EXPECT_GE(session->statistics().contacts(), 2u);
  EXPECT_GT(session->statistics().contact_time(), 5.0);
  EXPECT_GT(session->statistics().force_max(), 0.5);
  EXPECT_LT(session->statistics().force_max(), 3.0);
  const std::string contact = GetParam(), key = "tracker: ";
  if (contact.starts_with(key)) {
    support::Covered("trackers").add(contact.substr(key.size(), contact.find(',') - key.size()));
  }
}

std::vector<std::string> each_tracker() {
  std::vector<std::string> ways;
  for (const std::string_view name : render::kTrackerNames) {
    ways.push_back("tracker: " + std::string(name));
  }
  return ways;
}

INSTANTIATE_TEST_SUITE_P(Alone, EveryWayOfContact, ::testing::ValuesIn(each_tracker()));
INSTANTIATE_TEST_SUITE_P(
    Chosen, EveryWayOfContact,
    ::testing::Values("tracker: edge_planes, blending: fixed_band, band: 0.0005",
                      "tracker: edge_planes, blending: sized_band",
                      "tracker: edge_planes, blending: fixed_band, profile: smooth",
                      "tracker: offset, blending: sized_band, profile: smooth",
                      "tracker: edge_planes, blending: phong, curved_depth: true",
                      "tracker: offset, blending: flat, curved_depth: false",
                      "tracker: offset, crease_degrees: 30", "tracker: offset, normals: angle",
                      "tracker: offset, normals: round",
                      "tracker: edge_planes, blending: phong, normals: fitted",
                      "tracker: compact, normals: angle", "search: linear", "search: grid",
                      "search: tree", "tracker: god_object, search: linear",
                      "tracker: offset, search: tree", "tracker: compact, search: linear",
                      "tracker: compact, search: tree"));

TEST(WayOfContact, IncompatibleSettingsAreRefusedWithTheReason) {
  THIMBLE_NEEDS_MESHES();
  std::string error;
  EXPECT_FALSE(open_with("tracker: god_object, blending: phong", error));
  EXPECT_NE(error.find("\"god_object\" pushes towards its proxy"), std::string::npos) << error;
  EXPECT_FALSE(open_with("tracker: compact, blending: flat", error));
  EXPECT_NE(error.find("\"compact\" is always smooth"), std::string::npos) << error;
  EXPECT_FALSE(open_with("tracker: compact, normals: fitted", error));
  EXPECT_NE(error.find("\"compact\" always weights vertex normals by angle"), std::string::npos)
      << error;
  EXPECT_FALSE(open_with("tracker: god_object, normals: angle", error));
  EXPECT_NE(error.find("\"god_object\" does not use vertex normals"), std::string::npos) << error;
}

}  // namespace
}  // namespace thimble
