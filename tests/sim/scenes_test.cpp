#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "lost_contacts.h"
#include "session.h"
#include "support/heap_guard.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/mesh/adjacency.h"

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
                         ::testing::Values("sandpaper", "honey", "charges", "box", "ice", "rubber",
                                           "water_balloon", "trampoline", "soft_coarse"));

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

/// Mixes what a run felt and what it showed of its dents [FNV-1a, 64 bit].
std::uint64_t hash_of(const app::Session& session) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](const auto& value) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  };
  for (const auto& row : session.trace().rows()) {
    add(row.p_WT);
    add(row.f_sent_W);
    add(row.depth);
    add(row.feature);
  }
  const render::BodyPatch& dent = session.dents()->deepest();
  for (std::size_t i = 0; i < dent.point_count; ++i) add(dent.points[i].p);
  for (std::size_t i = 0; i < dent.point_count; ++i) add(dent.points[i].n);
  for (std::size_t i = 0; i < dent.triangle_count; ++i) add(dent.triangles[i]);
  return hash;
}

class DentedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(DentedScene, ShowsItsDentAndIsTheSameToTheBitInEveryRun) {
  std::uint64_t hash[2] = {};
  for (std::uint64_t& one : hash) {
    std::unique_ptr<app::Session> keep;
    app::Session* session = open(GetParam(), keep);
    ASSERT_TRUE(session);
    ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
    ASSERT_TRUE(session->dents());
    const render::BodyPatch& dent = session->dents()->deepest();
    EXPECT_GT(dent.triangle_count, 11) << "6 in place of one and 2 of each neighbour, at least";
    EXPECT_EQ(dent.share, 1) << "drawn in full";
    EXPECT_EQ(dent.object, 0);
    render::BodyPatch newest;
    EXPECT_TRUE(session->dents()->newest().load(newest));
    // The bent mesh is as closed as the one it came from.
    const auto whole = session->bent_mesh_W();
    EXPECT_GT(whole.triangles.size(), session->mesh_W().triangles.size());
    EXPECT_TRUE(render::find_adjacency(whole));
    one = hash_of(*session);
  }
  EXPECT_EQ(hash[0], hash[1]);
}

INSTANTIATE_TEST_SUITE_P(ByName, DentedScene,
                         ::testing::Values("water_balloon", "trampoline", "soft_coarse"));

TEST(SoftCoarse, IsBoundedAtATenthAndAtTenTimesItsStiffness) {
  for (const char* times : {"0.1", "10"}) {
    std::ifstream scene(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes/soft_coarse.yaml");
    std::stringstream text;
    text << scene.rdbuf();
    std::string changed = text.str();
    const auto put = [&changed](const std::string& from, const std::string& to) {
      const std::size_t at = changed.find(from);
      ASSERT_NE(at, std::string::npos) << from;
      changed.replace(at, from.size(), to);
    };
    const bool soft = std::string(times) == "0.1";
    put("stiffness: 30 ", soft ? "stiffness: 3 " : "stiffness: 300 ");
    put("neighbour_stiffness: 15 ",
        soft ? "neighbour_stiffness: 1.5 " : "neighbour_stiffness: 150 ");
    const auto folder = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app";
    put("mesh: soft_coarse.off", "mesh: " + (folder / "scenes/soft_coarse.off").string());
    put("arm: ../arms/", "arm: " + (folder / "arms/").string());
    const auto file =
        std::filesystem::temp_directory_path() /
        ("thimble_soft_" + std::string(times) + "_" + std::to_string(getpid()) + ".yaml");
    std::ofstream(file) << changed;
    auto opened = app::Session::open(file, {});
    std::filesystem::remove(file);
    ASSERT_TRUE(opened) << opened.error().message;
    app::Session& session = **opened;
    EXPECT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
    EXPECT_EQ(session.device().fault(), driver::Fault::kNone);
    const render::BodyPatch& dent = session.dents()->deepest();
    EXPECT_GT(dent.triangle_count, 11);
    for (std::size_t i = 0; i < dent.point_count; ++i) {
      for (const double x : dent.points[i].p) EXPECT_LT(std::abs(x), 0.15);
    }
  }
}

}  // namespace
}  // namespace thimble
