#include "share/viewer_watch.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "share/shared_reader.h"

namespace thimble::session {
namespace {

/// Run with two knobs and viewers in this process.
class ViewerWatchTest : public ::testing::Test {
 protected:
  ViewerWatchTest() {
    SharedScene scene;
    scene.name = "watched";
    scene.period_ns = 1'000'000;
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.triangles = {{0, 1, 2}};
    scene.objects.push_back({.name = "a", .vertex_count = 3, .triangle_count = 1});
    scene.knobs.push_back({"a: stiffness", "N/m", 0, 800, 400});
    scene.knobs.push_back({"a: damping", "N s/m", 0, 2, 1});
    run_ = SharedRun::create("", scene, 8).value();
    auto sink = std::make_shared<spdlog::sinks::ostream_sink_st>(said_);
    sink->set_pattern("%l %v");
    watch_.emplace(*run_, std::make_shared<spdlog::logger>("watched", sink));
  }

  std::unique_ptr<SharedReader> view() {
    return SharedReader::over(run_->memory().again().value()).value();
  }

  /// Checks `times` times and returns the logged text.
  std::string step(int times = 1) {
    said_.str("");
    for (int i = 0; i < times; ++i) {
      run_->watch_viewers();
      watch_->step("tick 5, 0.005 s: ");
    }
    return said_.str();
  }

  std::unique_ptr<SharedRun> run_;
  std::ostringstream said_;
  std::optional<ViewerWatch> watch_;
};

TEST_F(ViewerWatchTest, LogsAttachedAndDetachedViewers) {
  EXPECT_EQ(step(), "");
  const std::string self = std::to_string(getpid());
  auto viewer = view();
  EXPECT_EQ(step(), "info tick 5, 0.005 s: Viewer " + self + " has attached.\n");
  EXPECT_EQ(step(10), "");
  viewer.reset();
  EXPECT_EQ(step(), "info tick 5, 0.005 s: Viewer " + self + " has detached.\n");
  EXPECT_EQ(step(10), "");
}

TEST_F(ViewerWatchTest, LogsAViewerThatDied) {
  int ready[2];  // the child writes once it is attached
  int leave[2];  // the parent closes once it has detected the child
  ASSERT_EQ(pipe(ready), 0);
  ASSERT_EQ(pipe(leave), 0);
  const pid_t child = fork();
  char byte = 0;
  if (child == 0) {
    static const auto* const left_open = view().release();
    close(leave[1]);
    if (left_open == nullptr || write(ready[1], &byte, 1) != 1) _exit(1);
    _exit(read(leave[0], &byte, 1) == 0 ? 0 : 1);
  }
  close(ready[1]);
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  EXPECT_EQ(step(), "info tick 5, 0.005 s: Viewer " + std::to_string(child) + " has attached.\n");
  close(leave[1]);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(step(), "info tick 5, 0.005 s: Viewer " + std::to_string(child) + " has detached.\n");
  close(ready[0]);
  close(leave[0]);
}

TEST_F(ViewerWatchTest, ManyViewersFitAndMoreAreHarmless) {
  std::vector<std::unique_ptr<SharedReader>> viewers;
  for (std::size_t i = 0; i < kViewersMax + 3; ++i) viewers.push_back(view());
  EXPECT_EQ(run_->viewers().size(), kViewersMax);
  viewers.clear();
  EXPECT_TRUE(run_->viewers().empty());
}

TEST_F(ViewerWatchTest, LogsAKnobOnceItIsUnchanged) {
  const auto viewer = view();
  step();
  for (int i = 0; i < 20; ++i) {
    viewer->turn_knob(0, 400 + 10 * i);
    EXPECT_EQ(step(), "");
  }
  EXPECT_EQ(step(ViewerWatch::kSettled - 1), "");
  EXPECT_EQ(step(), "info tick 5, 0.005 s: A viewer set a: stiffness from 400 to 590 N/m.\n");
  EXPECT_EQ(step(20), "");
  viewer->turn_knob(0, 300);
  step();
  viewer->turn_knob(0, 590);  // back at its value: nothing was set
  EXPECT_EQ(step(20), "");
  viewer->turn_knob(1, 0.5);
  EXPECT_EQ(step(20), "info tick 5, 0.005 s: A viewer set a: damping from 1 to 0.5 N s/m.\n");
}

TEST_F(ViewerWatchTest, LogsAPause) {
  const auto viewer = view();
  step();
  viewer->ask_pause(true);
  EXPECT_EQ(step(3), "info tick 5, 0.005 s: A viewer paused the run.\n");
  viewer->ask_pause(false);
  EXPECT_EQ(step(3), "info tick 5, 0.005 s: A viewer resumed the run.\n");
}

}  // namespace
}  // namespace thimble::session
