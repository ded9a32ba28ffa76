// Pictures of several recordings: their arms in one scene, and their plots over each other.
#include <gtest/gtest.h>
#include <imgui.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "../gl_or_skip.h"
#include "../picture_difference.h"
#include "recorded_touch.h"
#include "view/compare/comparison.h"
#include "view/compare/recorded_runs.h"
#include "view/compare/run_colours.h"
#include "view/gl/picture_file.h"
#include "view/shot.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;
using support::difference;

/// Compares a picture with the stored one, or stores it.
void expect_as_stored(const Picture& drawn, const std::string& name) {
  const fs::path file = fs::path(THIMBLE_TEST_DATA) / "shots/compare" / (name + ".png");
  if (std::getenv("THIMBLE_WRITE_SHOTS") != nullptr) {
    fs::create_directories(file.parent_path());
    ASSERT_TRUE(write_png(drawn, file));
    return;
  }
  const auto stored = read_png(file);
  ASSERT_TRUE(stored) << stored.error().message;
  const auto found = difference(*stored, drawn);
  EXPECT_LE(found.mean, 2.5);  // as in shots_test.cpp
  EXPECT_LE(found.bad_blocks, 0.004);
}

/// Returns a scene with the ball of rubber.yaml, which a hand touches from the other side.
fs::path from_the_other_side() {
  std::ifstream shipped(support::shipped_scene("rubber"));
  std::string text{std::istreambuf_iterator<char>(shipped), {}};
  for (std::size_t at = 0; (at = text.find(", -0.02, ", at)) != std::string::npos;) {
    text.replace(at, 9, ", 0.02, ");
  }
  fs::path file = support::scratch_folder() / "other_side.yaml";
  std::ofstream(file) << text;
  return file;
}

Plots wave(double begin, double seconds, double height) {
  Plots plots = Plots::of_recording();
  for (int i = 0; i < std::lround(1000 * seconds); ++i) {
    driver::TickRecord tick;
    tick.time_ns = std::llround(1e9 * begin) + i * std::int64_t{1'000'000};
    tick.f_sent_W = {0, 0, height * (1.2 + std::sin(3e-3 * i))};
    plots.add(tick);
  }
  return plots;
}

TEST(CompareShots, PlotsOfRecordingsLieOverEachOther) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  const Plots longer = wave(0, 4, 1);
  const Plots shorter = wave(70, 2.5, 0.6);
  Comparison comparison;
  for (const Plots* plots : {&longer, &shorter}) {
    ComparedRun& run = comparison.runs.emplace_back();
    run.colour = kRunColours[comparison.runs.size() - 1];
    run.plots = plots;
    run.offset = plots->kept().begin;
  }
  OwnSignals own;
  std::vector<double> time;
  own.signals.push_back({"muscle", "V", {}});
  own.signals.push_back({"constant", "", {}});
  for (int i = 0; i < 300; ++i) {
    time.push_back(0.5 + 0.01 * i);
    own.signals[0].values.push_back(3e-5F * static_cast<float>(std::sin(0.05 * i)));
    own.signals[1].values.push_back(101'325);
  }
  own.time = std::make_shared<const std::vector<double>>(std::move(time));
  std::vector<OwnSignals> files;
  files.push_back(std::move(own));
  const auto signals = signals_of(std::move(files), 2);

  Canvas canvas(480, 320);
  PictureText text(1);
  text.begin(480, 320);
  fill_part({0, 0, 480, 320}, kGroundColour);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ChannelCurves force(comparison, Channel::kForce);
  const PlotMarks marks{.cursor = {}, .looked = 1.5, .times = false};
  draw_curves(list, {10, 5, 460, 100}, look_of(Channel::kForce), force.drawn, {0, 4}, marks);
  draw_curves(list, {10, 105, 460, 100}, signals[0].look, drawn_curves(signals[0]), {0, 4}, marks);
  draw_curves(list, {10, 205, 460, 110}, signals[1].look, drawn_curves(signals[1]), {0, 4},
              {.cursor = 3, .looked = 1.5, .times = true});
  canvas.begin_pixels();
  text.end();
  expect_as_stored(canvas.read(), "plots");
}

TEST(CompareShots, ArmsOfTwoRecordingsAreInOneScene) {
  const auto context = support::open_gl();
  if (!context) GTEST_SKIP() << "no OpenGL";
  const auto runs = RecordedRuns::open(
      {.recordings = {support::record_touch(support::shipped_scene("rubber"), "long", 1.6, 1),
                      support::record_touch(from_the_other_side(), "short", 1.1, 1)},
       .signals = {},
       .scene_of = {}});
  ASSERT_TRUE(runs) << runs.error().message;
  ShotChoice choice;
  choice.width = 320;
  choice.height = 240;
  choice.caption = false;
  ShotPainter painter((*runs)->scene(), choice, ScenePrograms::make().value());
  const auto moment = std::make_unique<DrawnMoment>();
  const auto paint = [&](double time, bool others) {
    (*runs)->show(time, *moment);
    if (!others) moment->others.clear();
    return painter.paint(*moment, (*runs)->comparison().runs[0].plots[0]);
  };
  (*runs)->show(1.05, *moment);
  painter.frame_at(*moment);
  const Picture both = paint(1.05, true);
  const Picture ended = paint(1.5, true);
  EXPECT_GT(difference(both, paint(1.05, false)).mean, 0.3);
  expect_as_stored(both, "both");
  expect_as_stored(ended, "ended");
}

}  // namespace
}  // namespace thimble::view
