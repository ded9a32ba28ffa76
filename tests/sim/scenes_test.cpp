#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "lost_contacts.h"
#include "session.h"
#include "support/heap_guard.h"
#include "thimble/render/effect/effect_table.h"

// Every scene without a scanned mesh that comes with the program, from the wire up.

namespace thimble {
namespace {

app::Session* open(const std::string& name, std::unique_ptr<app::Session>& keep) {
  auto opened = app::Session::open(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" / (name + ".yaml"), {});
  EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
  if (!opened) return nullptr;
  keep = std::move(opened).value();
  return keep.get();
}

bool has_friction() {
  return std::any_of(render::effect_table().begin(), render::effect_table().end(),
                     [](const auto& kind) { return kind.group == "friction"; });
}

class ShippedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedScene, RunsForItsWholeTimeWithoutAFaultOrALostContact) {
  const std::string name = GetParam();
  if ((name == "ice" || name == "rubber") && !has_friction()) {
    GTEST_SKIP() << "this build knows no friction";
  }
  std::unique_ptr<app::Session> keep;
  app::Session* session = open(name, keep);
  ASSERT_TRUE(session);
  EXPECT_GT(session->scene().description.size(), 40u) << "says what to feel";
  driver::ServoEnd end{};
  EXPECT_EQ(support::heap_calls_of([&] { end = session->run(std::atomic<bool>{false}); }), 0);
  EXPECT_EQ(end, driver::ServoEnd::kDone);
  EXPECT_EQ(session->device().fault(), driver::Fault::kNone);
  EXPECT_EQ(app::count_lost_contacts(session->trace().rows(), session->touch()), 0u);
  EXPECT_GT(session->statistics().force_max(), 0.3);
  EXPECT_LT(session->statistics().force_max(), session->scene().arm.limits.force_max);
  // What an ideal texture or field does not do, a loop of 1 kHz with a delay does a little
  // [STABILITY 1.5]; felt is what exceeds a millijoule.
  EXPECT_LT(session->statistics().energy_to_hand(), 1e-3);
}

// A test's name may hold letters, digits and underscores only; so do the names of scenes.
INSTANTIATE_TEST_SUITE_P(ByName, ShippedScene,
                         ::testing::Values("sandpaper", "honey", "charges", "box", "ice",
                                           "rubber"));

TEST(BoxScene, TurnsTheForceInWedgesButNotByTheEntryFace) {
  std::unique_ptr<app::Session> keep;
  app::Session* session = open("box", keep);
  ASSERT_TRUE(session);
  ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  bool felt[2][6] = {};
  for (const auto& row : session->trace().rows()) {
    if (row.in_contact) felt[row.object][row.feature] = true;
  }
  constexpr int kRight = 3, kTop = 5;  // the user's right is y
  EXPECT_TRUE(felt[0][kTop]);
  EXPECT_FALSE(felt[0][kRight]);
  EXPECT_TRUE(felt[1][kTop]);
  EXPECT_TRUE(felt[1][kRight]);
}

}  // namespace
}  // namespace thimble
