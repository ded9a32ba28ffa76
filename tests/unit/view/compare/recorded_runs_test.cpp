#include "view/compare/recorded_runs.h"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>

#include "recorded_touch.h"
#include "view/compare/run_colours.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;
using support::record_touch;
using support::shipped_scene;

std::unique_ptr<RecordedRuns> opened(const ComparedFiles& files) {
  auto runs = RecordedRuns::open(files);
  if (runs) return std::move(runs).value();
  ADD_FAILURE() << runs.error().message;
  return nullptr;
}

std::string error_of(const ComparedFiles& files) {
  const auto runs = RecordedRuns::open(files);
  return runs ? "no error" : runs.error().message;
}

bool has(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

fs::path signal_file(const std::string& name, const std::string& text) {
  const fs::path file = support::scratch_folder() / name;
  std::ofstream(file) << text;
  return file;
}

/// Two runs of a ball, of 0.6 s and 0.4 s.
ComparedFiles two_balls() {
  return {.recordings = {record_touch(shipped_scene("rubber"), "long", 0.6, 1),
                         record_touch(shipped_scene("rubber"), "short", 0.4, 2)},
          .signals = {},
          .scene_of = {}};
}

TEST(RecordedRuns, MomentHasTheTicksOfEachRecording) {
  const auto runs = opened(two_balls());
  ASSERT_NE(runs, nullptr);
  ASSERT_EQ(runs->size(), 2U);
  EXPECT_NEAR(runs->axis().span().end, 0.599, 1e-9);
  const auto moment = std::make_unique<DrawnMoment>();
  for (const double time : {0.3, 0.0, 0.1234}) {  // in any order
    runs->show(time, *moment);
    const auto tick = static_cast<std::uint64_t>(1000 * time + 1e-6);
    EXPECT_EQ(moment->tick.tick, tick);
    EXPECT_EQ(moment->tick.p_WT, runs->run(0).ticks()[tick].p_WT);
    ASSERT_EQ(moment->others.size(), 1U);
    EXPECT_EQ(moment->others[0].tick.tick, tick);
    EXPECT_EQ(moment->others[0].tick.p_WT, runs->run(1).ticks()[tick].p_WT);
    EXPECT_FALSE(moment->others[0].rods.empty());
    EXPECT_EQ(moment->look.colour, kRunColours[0]);
    EXPECT_EQ(moment->others[0].look.colour, kRunColours[1]);
    EXPECT_EQ(runs->comparison().runs[1].tick.tick, tick);
  }
  EXPECT_TRUE(runs->warnings().empty());
}

TEST(RecordedRuns, ShorterOneStandsAtItsEnd) {
  const auto runs = opened(two_balls());
  ASSERT_NE(runs, nullptr);
  const auto moment = std::make_unique<DrawnMoment>();
  runs->show(0.5, *moment);
  EXPECT_EQ(moment->tick.tick, 500U);
  EXPECT_FALSE(moment->look.ended);
  EXPECT_EQ(moment->others.at(0).tick.tick, 399U);
  EXPECT_TRUE(moment->others[0].look.ended);
  EXPECT_EQ(moment->others[0].look.colour, ended_colour(kRunColours[1]));
  EXPECT_FALSE(runs->comparison().runs[0].ended);
  EXPECT_TRUE(runs->comparison().runs[1].ended);
}

TEST(RecordedRuns, StepsFromTickToTickOfTheLongest) {
  ComparedFiles files = two_balls();
  files.scene_of = files.recordings[1];  // the shorter one
  const auto runs = opened(files);
  ASSERT_NE(runs, nullptr);
  EXPECT_EQ(runs->comparison().drawn, 1U);
  double time = 0;
  for (int i = 1; i < 600; ++i) {
    time = runs->time_of_step(time, 1);
    ASSERT_NEAR(time, 1e-3 * i, 1e-9);
  }
  for (int i = 598; i >= 0; --i) {
    time = runs->time_of_step(time, -1);
    ASSERT_NEAR(time, 1e-3 * i, 1e-9);
  }
}

TEST(RecordedRuns, OfOtherScenesOnlyPlotsAreShared) {
  const ComparedFiles files{
      .recordings = {record_touch(shipped_scene("rubber"), "ball", 0.3, 1),
                     record_touch(shipped_scene("sandpaper"), "paper", 0.3, 1)},
      .signals = {},
      .scene_of = {}};
  const auto runs = opened(files);
  ASSERT_NE(runs, nullptr);
  const auto moment = std::make_unique<DrawnMoment>();
  runs->show(0.2, *moment);
  EXPECT_TRUE(moment->others.empty());
  EXPECT_EQ(runs->scene().name, "rubber");
  EXPECT_EQ(runs->comparison().runs[1].plots->kept().width(), runs->run(1).time().width());
  EXPECT_TRUE(runs->comparison().scenes_differ());
  ASSERT_EQ(runs->warnings().size(), 1U);
  for (const char* word : {"paper.h5", "sandpaper", "ball.h5", "--scene-of"}) {
    EXPECT_TRUE(has(runs->warnings()[0], word)) << runs->warnings()[0];
  }
  runs->draw_scene_of(1);
  runs->show(0.2, *moment);
  EXPECT_EQ(runs->scene().name, "sandpaper");
  EXPECT_EQ(moment->tick.p_WT, runs->run(1).ticks()[200].p_WT);
  EXPECT_TRUE(has(runs->warnings().at(0), "ball.h5")) << runs->warnings()[0];
}

TEST(RecordedRuns, RecordingsOfSeveralArmsAreOneRun) {
  const fs::path file = record_touch(shipped_scene("two_hands"), "hands", 0.2, 1);
  const auto runs = opened(
      {.recordings = {session::file_of_arm(file, "left"), session::file_of_arm(file, "right")},
       .signals = {},
       .scene_of = {}});
  ASSERT_NE(runs, nullptr);
  EXPECT_EQ(runs->size(), 1U);
  const auto moment = std::make_unique<DrawnMoment>();
  runs->show(0.1, *moment);
  EXPECT_EQ(moment->others.size(), 1U);
  EXPECT_EQ(moment->look.colour, std::nullopt);
}

TEST(RecordedRuns, SignalsShareTheAxis) {
  ComparedFiles files = two_balls();
  files.signals = {signal_file("emg.csv", "time,emg [mV]\n-0.2,0\n0,1\n0.9,2\n")};
  const auto runs = opened(files);
  ASSERT_NE(runs, nullptr);
  EXPECT_EQ(runs->comparison().span.end, 0.9);
  ASSERT_EQ(runs->comparison().signals.size(), 1U);
  EXPECT_EQ(runs->comparison().signals[0].curves[0]->value_at(0.5), 1);
  EXPECT_TRUE(has(runs->about().back(), "emg.csv: 1 value before the first tick"))
      << runs->about().back();
  // Beyond the last tick, a step is a period.
  EXPECT_NEAR(runs->time_of_step(0.7, 1), 0.701, 1e-12);
  const auto moment = std::make_unique<DrawnMoment>();
  runs->show(0.8, *moment);
  EXPECT_TRUE(moment->look.ended);
  EXPECT_TRUE(moment->others.at(0).look.ended);
}

TEST(RecordedRuns, ErrorsNameFileAndRemedy) {
  ComparedFiles files = two_balls();
  files.signals = {signal_file("clock.csv", "time,a\n1700000000,0\n1700000001,0\n")};
  std::string error = error_of(files);
  EXPECT_TRUE(has(error, "clock.csv") && has(error, "Subtract")) << error;
  files.signals = {signal_file("broken.csv", "time,a\n0,b\n")};
  error = error_of(files);
  EXPECT_TRUE(has(error, "broken.csv:2")) << error;
  files.signals.clear();
  files.scene_of = "other.h5";
  error = error_of(files);
  EXPECT_TRUE(has(error, "--scene-of: other.h5") && has(error, "short.h5")) << error;
  files.scene_of.clear();
  files.recordings.insert(files.recordings.end(), 5, files.recordings[0]);
  error = error_of(files);
  EXPECT_TRUE(has(error, "7 recordings") && has(error, "6")) << error;
  files.recordings = {files.recordings[0], fs::path(THIMBLE_SOURCE_DIR) / "README.md"};
  error = error_of(files);
  EXPECT_TRUE(has(error, "README.md")) << error;
}

}  // namespace
}  // namespace thimble::view
