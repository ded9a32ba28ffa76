#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "figures/lost_contacts.h"
#include "report/report.h"
#include "setup.h"
#include "studies/ring_pages.h"
#include "support/scratch.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

/// Writes a scene with a paged ring, 90 mm wide, and with the given lines in its object.
std::filesystem::path scene(const std::string& object_lines, const std::string& station) {
  const auto folder = support::scratch_folder();
  if (!std::filesystem::exists(folder / "ring.pages")) {
    const studies::BumpyRing ring;
    EXPECT_TRUE(
        studies::write_ring(ring, studies::ring_grid(ring, 100'000), folder / "ring.pages").ok());
  }
  const auto file = folder / "ring.yaml";
  std::ofstream(file) << "name: ring\narm: " << THIMBLE_SOURCE_DIR
                      << "/app/arms/vintage_phantom.yaml\nduration: 2.6\nseed: 1\nobjects:\n"
                         "  - name: ring\n    mesh: ring.pages\n    size: 0.09\n"
                         "    rotate_degrees: [[z, 20]]\n    stiffness: 700\n    damping: 1\n"
                      << object_lines
                      << "hand:\n  path:\n    - {t: 0, at: [0.0317, 0, 0.035]}\n"
                         "    - {t: 0.8, at: [0.0317, 0, 0.009]}\n"
                         "    - {t: 1.8, at: [0.0290, 0.012, 0.009]}\n"
                      << station << "    - {t: 2.6, at: [0.0290, 0.012, 0.035]}\n";
  return file;
}

std::string refusal(const std::string& object_lines, const std::string& station) {
  const auto opened = session::Session::open(scene(object_lines, station), {});
  return opened ? "" : opened.error().message;
}

TEST(PagedScene, RunsFromDiskAreBitIdentical) {
  std::vector<std::array<double, 3>> forces;
  for (int run = 0; run < 2; ++run) {
    const auto opened = session::Session::open(scene("", ""), {});
    ASSERT_TRUE(opened) << opened.error().message;
    session::Session& session = **opened;
    ASSERT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
    const auto rows = session.ticks();
    const auto touching =
        std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.in_contact; });
    EXPECT_GT(touching, 1000);
    EXPECT_EQ(session::count_lost_contacts(rows, session.touch()), 0u);
    ASSERT_TRUE(session.setup().objects().paging().has_value());
    EXPECT_EQ(session.setup().objects().paging()->misses, 0u);
    EXPECT_GE(session.setup().objects().paging()->loads, 4u);
    EXPECT_GT(session.setup().objects().triangles(), 90'000u);
    // On top of the tube of 0.0127 m with bumps, or next to it where the tip slides off.
    for (const auto& row : rows) {
      EXPECT_TRUE(!row.in_contact || std::abs(row.p_WT[2] - 0.0112) < 0.0025) << row.p_WT[2];
    }
    if (run == 0) {
      for (const auto& row : rows) forces.push_back(row.f_sent_W);
      continue;
    }
    ASSERT_EQ(forces.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_EQ(forces[i], rows[i].f_sent_W);
  }
}

TEST(PagedScene, BudgetLimitsThePagesInMemory) {
  // Around half of the ring.
  const std::string round =
      "    - {t: 2.1, at: [0, 0.0317, 0.009]}\n    - {t: 2.4, at: [-0.0317, 0, 0.009]}\n";
  std::vector<std::array<double, 3>> forces;
  for (const char* budget : {"", "    budget: 1\n"}) {
    const auto opened = session::Session::open(scene(budget, round), {});
    ASSERT_TRUE(opened) << opened.error().message;
    session::Session& session = **opened;
    ASSERT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
    const auto paging = *session.setup().objects().paging();
    EXPECT_EQ(paging.evictions > 0, *budget != 0) << budget;
    EXPECT_EQ(paging.misses, 0u);
    std::vector<std::array<double, 3>> now;
    for (const auto& row : session.ticks()) now.push_back(row.f_sent_W);
    if (*budget != 0) {
      EXPECT_EQ(now, forces);
    }
    forces = now;
  }
}

TEST(PagedScene, DamagedPagesAreAnErrorAfterTheRun) {
  const auto file = scene("", "");
  const auto pages = file.parent_path() / "ring.pages";
  for (const bool damaged : {false, true}) {
    if (damaged) {
      // One bit in each page.
      std::fstream stream(pages, std::ios::binary | std::ios::in | std::ios::out);
      const auto size = static_cast<std::streamoff>(std::filesystem::file_size(pages));
      for (std::streamoff at = size - 1; at > 65536; at -= 65536) {
        stream.seekg(at);
        const int byte = stream.get();
        stream.seekp(at);
        stream.put(static_cast<char>(byte ^ 1));
      }
    }
    const auto opened = session::Session::open(file, {});
    ASSERT_TRUE(opened) << opened.error().message;
    session::Session& session = **opened;
    ASSERT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
    const auto read = session.setup().objects().check_pages(session.scene());
    EXPECT_EQ(read.ok(), !damaged);
    if (damaged) {
      EXPECT_NE(read.error().message.find("ring.pages: "), std::string::npos);
      EXPECT_NE(read.error().message.find("could not be read"), std::string::npos);
      EXPECT_NE(read.error().message.find("thimble mesh page"), std::string::npos);
    }
  }
  std::filesystem::remove(pages);
}

TEST(PagedScene, RefusesABudgetThatIsInvalidOrForAMeshInMemory) {
  EXPECT_NE(refusal("    budget: 0\n", "").find("budget: expected a whole number from 1 to "),
            std::string::npos);
  const auto file = support::scratch_folder() / "ball.yaml";
  std::ofstream(file) << "name: ball\narm: vintage_phantom\nduration: 1\nobjects:\n"
                         "  - {name: b, mesh: \""
                      << THIMBLE_SOURCE_DIR
                      << "/app/scenes/clay_ball.off\", stiffness: 100, budget: 4}\n"
                         "hand: {path: [{t: 0, at: [0, 0, 0]}]}\n";
  const auto read = scene::load_scene(file);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("budget: applies to page files only"), std::string::npos);
}

TEST(PagedScene, RefusesFeaturesThatNeedTheWholeMesh) {
  EXPECT_EQ(refusal("    contact: {tracker: compact}\n", ""), "");
  EXPECT_NE(refusal("    contact: {tracker: offset}\n", "").find("a page file supports only"),
            std::string::npos);
  EXPECT_NE(refusal("    contact: {tracker: compact, crease_degrees: 40}\n", "")
                .find("a page file supports only"),
            std::string::npos);
  EXPECT_NE(refusal("", "    - {t: 2, on: ring, near: [0.03, 0, 0.01]}\n")
                .find("a page file is not in memory"),
            std::string::npos);
}

TEST(PagedScene, RealTimeRunUsesALoaderThread) {
  session::SessionOptions options;
  options.clock = session::ClockKind::kWall;
  options.duration = 1.2;
  // A busy machine may end the loop, but nothing else may; one of the runs must get this far.
  bool loaded = false;
  for (int run = 0; run < 20 && !loaded; ++run) {
    const auto opened = session::Session::open(scene("", ""), options);
    ASSERT_TRUE(opened) << opened.error().message;
    session::Session& session = **opened;
    const driver::ServoEnd end = session.run(std::atomic<bool>{false});
    ASSERT_TRUE(end == driver::ServoEnd::kDone || end == driver::ServoEnd::kFault);
    loaded = session.setup().objects().paging()->loads > 0;
    session::RunFigures report;
    report.paging = session.figures().paging;
    EXPECT_NE(session::summary(report).find("read from disk"), std::string::npos);
  }
  EXPECT_TRUE(loaded);
}

}  // namespace
}  // namespace thimble
