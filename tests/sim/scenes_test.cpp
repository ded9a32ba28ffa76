#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "figures/lost_contacts.h"
#include "mesh/adjacency.h"
#include "run_records.h"
#include "setup.h"
#include "support/heap_guard.h"
#include "support/run_hash.h"
#include "support/shipped_scene.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

// Every shipped scene without a scanned mesh, through the complete chain.

namespace thimble {
namespace {

struct SceneRun {
  const char* name;
  // Hash of the ticks and of the final shapes of bodies, equal for every build type; see
  // determinism_test.cpp. A change of the scene, the arm's data or any force changes it: store a
  // new hash only for an intended change.
  std::uint64_t stored;
};

void PrintTo(const SceneRun& scene, std::ostream* out) {
  *out << scene.name;
}

std::uint64_t hash_of_touch(const session::Session& session) {
  support::RunHash hash;
  for (const auto& row : session.ticks()) hash.add(row);
  for (const Eigen::Vector3d& p : session.mesh_now().vertices) {
    for (const double x : p) hash.add(x);
  }
  if (session.records().dents != nullptr) {
    const render::BodyPatch& dent = session.records().dents->deepest();
    for (std::size_t i = 0; i < dent.point_count; ++i) hash.add(dent.points[i].p);
    for (std::size_t i = 0; i < dent.point_count; ++i) hash.add(dent.points[i].n);
    for (std::size_t i = 0; i < dent.triangle_count; ++i) hash.add(dent.triangles[i]);
  }
  return hash.value();
}

class ShippedScene : public ::testing::TestWithParam<SceneRun> {};

TEST_P(ShippedScene, CompletesRepeatablyWithoutFaultsOrHeap) {
  std::uint64_t first = 0;
  for (int time = 0; time < 2; ++time) {
    const auto session = support::open_shipped(GetParam().name);
    ASSERT_TRUE(session);
    EXPECT_GT(session->scene().description.size(), 40u) << "the scene needs a description";
    driver::ServoEnd end{};
    EXPECT_EQ(support::heap_calls_of([&] { end = session->run(std::atomic<bool>{false}); }), 0);
    EXPECT_EQ(end, driver::ServoEnd::kDone);
    EXPECT_EQ(session->device().fault(), driver::Fault::kNone);
    EXPECT_EQ(session::count_lost_contacts(session->ticks(), session->touch()), 0u);
    EXPECT_GT(session->statistics().force_max(), 0.3);
    EXPECT_LT(session->statistics().force_max(),
              session->scene().arms.front().arm.limits.force_max);
    // An ideal texture or field adds no energy; a loop of 1 kHz with a delay adds a little [PHYSICS
    // 1.5]. More than a millijoule is perceptible.
    EXPECT_LT(session->statistics().energy_to_hand(), 1e-3);
    const std::uint64_t hash = hash_of_touch(*session);
    if (time == 0) first = hash;
    EXPECT_EQ(hash, first);
    EXPECT_EQ(hash, GetParam().stored) << "new hash: 0x" << std::hex << hash;
  }
}

// A test's name may contain only letters, digits and underscores; so do the names of scenes.
INSTANTIATE_TEST_SUITE_P(
    ByName, ShippedScene,
    ::testing::Values(
        SceneRun{"box", 0x9e8f2abb72cebbbb}, SceneRun{"charges", 0x9c431739f0314c51},
        SceneRun{"clay", 0x63638a448aa1ea7c}, SceneRun{"clay_tablet", 0x6fcc76fa219aff64},
        SceneRun{"floating_block", 0xac0387049430abb6}, SceneRun{"held_block", 0x27f2a809da9c1a68},
        SceneRun{"honey", 0x956a38caf003103e}, SceneRun{"ice", 0xd045e322156e6abf},
        SceneRun{"rubber", 0x9afcad3a5a7c23bc}, SceneRun{"sandpaper", 0x3de7219191bf4078},
        SceneRun{"soft_coarse", 0x9e694768bd5670fa}, SceneRun{"tin_can", 0x23b9e5de26b2de4e},
        SceneRun{"trampoline", 0x7af5bdbc06ca833}, SceneRun{"water_balloon", 0xd58d0192f31de9f0}),
    [](const auto& scene) { return std::string(scene.param.name); });

TEST(BoxScene, OnlyTheRightBoxIsTouchedOnItsSide) {
  const auto session = support::open_shipped("box");
  ASSERT_TRUE(session);
  ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  bool felt[2][6] = {};
  for (const auto& row : session->ticks()) {
    if (row.in_contact) felt[row.object][row.feature] = true;
  }
  constexpr int kRight = 3, kTop = 5;  // the user's right is y
  EXPECT_TRUE(felt[0][kTop]);
  EXPECT_FALSE(felt[0][kRight]);
  EXPECT_TRUE(felt[1][kTop]);
  EXPECT_TRUE(felt[1][kRight]);
}

class DentedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(DentedScene, ShowsItsDent) {
  const auto session = support::open_shipped(GetParam());
  ASSERT_TRUE(session);
  ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  ASSERT_TRUE(session->records().dents);
  const render::BodyPatch& dent = session->records().dents->deepest();
  EXPECT_GT(dent.triangle_count, 11) << "at least 6 instead of one, and 2 of each neighbour";
  EXPECT_EQ(dent.share, 1) << "drawn completely";
  EXPECT_EQ(dent.object, 0);
  EXPECT_GT(session->records().dents->drawn().drawings, 0u);
  // The deformed mesh is as watertight as the original.
  const auto whole = session->deepest_dent();
  ASSERT_TRUE(whole);
  EXPECT_GT(whole->triangles.size(), session->setup().objects().mesh_W().triangles.size());
  EXPECT_TRUE(render::find_adjacency(*whole));
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
    const auto file =
        std::filesystem::temp_directory_path() /
        ("thimble_soft_" + std::string(times) + "_" + std::to_string(getpid()) + ".yaml");
    std::ofstream(file) << changed;
    auto opened = session::Session::open(file, {});
    std::filesystem::remove(file);
    ASSERT_TRUE(opened) << opened.error().message;
    session::Session& session = **opened;
    EXPECT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
    EXPECT_EQ(session.device().fault(), driver::Fault::kNone);
    const render::BodyPatch& dent = session.records().dents->deepest();
    EXPECT_GT(dent.triangle_count, 11);
    for (std::size_t i = 0; i < dent.point_count; ++i) {
      for (const double x : dent.points[i].p) EXPECT_LT(std::abs(x), 0.15);
    }
  }
}

}  // namespace
}  // namespace thimble
