// Pictures over time: a recording looks like its run, and plots match the stored picture.
#include <gtest/gtest.h>
#include <imgui.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "gl_or_skip.h"
#include "picture_difference.h"
#include "support/scratch.h"
#include "view/gl/picture_file.h"
#include "view/playback/recording_view.h"
#include "view/shot.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;
using support::difference;

TEST(TimeShots, RecordingLooksLikeItsRun) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  session::SessionOptions options;
  options.duration = 1.45;
  options.record = support::scratch_folder() / "run.h5";
  ShotChoice choice;
  choice.width = 320;
  choice.height = 240;
  choice.caption = false;
  std::vector<std::pair<DrawnMoment, Picture>> seen;
  {
    auto played =
        PlayedScene::open(fs::path(THIMBLE_SOURCE_DIR) / "app/scenes/water_balloon.yaml", options);
    ASSERT_TRUE(played) << played.error().message;
    ShotPainter painter((*played)->drawn(), choice, ScenePrograms::make().value());
    (*played)->play({0.4, 0.907, 1.4}, [&](DrawnMoment& moment, const Plots& plots) {
      seen.emplace_back(moment, painter.paint(moment, plots));
      choice.camera = painter.camera();
    });
  }
  const auto recorded = RecordingView::open({options.record});
  ASSERT_TRUE(recorded) << recorded.error().message;
  ShotPainter painter((*recorded)->scene(), choice, ScenePrograms::make().value());
  const auto now = std::make_unique<DrawnMoment>();
  std::optional<Picture> before;
  for (const auto& [then, picture] : seen) {
    (*recorded)->show(1e-9 * static_cast<double>(then.tick.time_ns), *now);
    const Picture again = painter.paint(*now, (*recorded)->plots());
    const auto found = difference(picture, again);
    EXPECT_LE(found.mean, 0.01);
    EXPECT_EQ(found.bad_blocks, 0);
    // Control: another moment looks different.
    if (before) {
      EXPECT_GT(difference(*before, picture).mean, 0.05);
    }
    before = picture;
  }
}

TEST(TimeShots, PlotsMatchStoredShot) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  Plots plots = Plots::of_recording();
  for (int i = 0; i < 4000; ++i) {
    driver::TickRecord tick;
    tick.time_ns = i * std::int64_t{1'000'000};
    const double t = 1e-3 * i;
    tick.f_sent_W = {0, 0, 1.2 + std::sin(3 * t)};
    tick.in_contact = std::sin(2 * t) > 0;
    tick.depth = 3e-5 * std::sin(2 * t);
    tick.p_WT = {0.02 * std::cos(t), -0.01, 0};
    plots.add(tick);
  }
  Canvas canvas(480, 420);
  PictureText text(1);
  text.begin(480, 420);
  fill_part({0, 0, 480, 420}, kGroundColour);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const Plots::Marks marks{.cursor = 1.3, .looked = 2.2, .times = false};
  plots.draw(list, {10, 5, 460, 100}, Channel::kForce, {0, 4}, marks);
  plots.draw(list, {10, 105, 460, 100}, Channel::kDepth, {0, 4}, marks);
  plots.draw(list, {10, 205, 460, 110}, Channel::kX, {2.19, 2.21}, {});
  plots.draw_periods(list, {10, 315, 460, 100}, {0, 4}, 1'000'000);
  canvas.begin_pixels();
  text.end();
  const Picture drawn = canvas.read();
  const fs::path stored_file = fs::path(THIMBLE_TEST_DATA) / "shots/plots/plots.png";
  if (std::getenv("THIMBLE_WRITE_SHOTS") != nullptr) {
    fs::create_directories(stored_file.parent_path());
    ASSERT_TRUE(write_png(drawn, stored_file));
    return;
  }
  const auto stored = read_png(stored_file);
  ASSERT_TRUE(stored) << stored.error().message;
  const auto found = difference(*stored, drawn);
  EXPECT_LE(found.mean, 2.5);  // as in shots_test.cpp
  EXPECT_LE(found.bad_blocks, 0.004);
}

}  // namespace
}  // namespace thimble::view
