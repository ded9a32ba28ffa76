#include "view/playback/time_line.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>

#include <memory>

#include "share/shared_run.h"

#include "clockwork.h"
#include "screenless.h"

namespace thimble::view {
namespace {

class TimeLineUsed : public Screenless {
 protected:
  TimeLineUsed() : Screenless(900, 40) {}

  static void look(Clockwork& source, const ImVec2& mouse, bool left) {
    frame(mouse, left, 0, [&source] { TimeLine::draw({0, 0, 900, 36}, source); });
  }
};

TEST_F(TimeLineUsed, DragsToAnyMomentAndBackToNow) {
  Clockwork run(PlayHead::of_run());
  run.head().set_span(10, 70);
  EXPECT_EQ(words_of(run.head()), "now");
  for (int i = 0; i < 3; ++i) look(run, {600, 20}, false);
  look(run, {600, 20}, true);
  look(run, {602, 20}, true);
  EXPECT_FALSE(run.head().live());
  const double then = run.head().time();
  EXPECT_GT(then, 30);
  EXPECT_LT(then, 65);
  look(run, {602, 20}, false);
  run.head().set_span(12, 72);
  EXPECT_EQ(run.head().time(), then);
  EXPECT_EQ(words_of(run.head()).substr(4), " s behind");
  look(run, {602, 20}, true);
  look(run, {899, 20}, true);
  EXPECT_TRUE(run.head().live());
}

TEST_F(TimeLineUsed, HandlesOnlyItsKeys) {
  Clockwork recording(PlayHead::of_recording());
  PlayHead& head = recording.head();
  head.set_span(0, 2);
  EXPECT_TRUE(TimeLine::take_key(GLFW_KEY_SPACE, recording));
  EXPECT_FALSE(head.plays());
  EXPECT_TRUE(TimeLine::take_key(GLFW_KEY_RIGHT, recording));
  EXPECT_DOUBLE_EQ(head.time(), 0.001);
  ImGui::GetIO().KeyShift = true;
  EXPECT_TRUE(TimeLine::take_key(GLFW_KEY_RIGHT, recording));
  ImGui::GetIO().KeyShift = false;
  EXPECT_DOUBLE_EQ(head.time(), 1.001);
  EXPECT_EQ(words_of(head), "1.001 of 2.000 s");
  EXPECT_TRUE(TimeLine::take_key(GLFW_KEY_LEFT, recording));
  EXPECT_DOUBLE_EQ(head.time(), 1.0);
  EXPECT_TRUE(TimeLine::take_key(GLFW_KEY_END, recording));
  EXPECT_EQ(head.time(), 2);
  EXPECT_TRUE(TimeLine::take_key(GLFW_KEY_HOME, recording));
  EXPECT_EQ(head.time(), 0);
  EXPECT_TRUE(TimeLine::take_key(GLFW_KEY_COMMA, recording));
  EXPECT_EQ(head.speed(), 0.5);
  EXPECT_FALSE(TimeLine::take_key(GLFW_KEY_S, recording));
  EXPECT_FALSE(TimeLine::take_key(GLFW_KEY_LEFT, recording, false));  // the key of the hand
}

/// A run that is shared, and a source that shows it.
struct ShownRun {
  std::unique_ptr<session::SharedRun> run = make();
  std::unique_ptr<session::SharedReader> reader =
      session::SharedReader::over(run->memory().again().value()).value();
  Clockwork source{PlayHead::of_run(), reader.get()};

  ShownRun() {
    run->set_state(session::RunState::kRunning);
    source.head().set_span(10, 70);
  }
  static std::unique_ptr<session::SharedRun> make() {
    session::SharedScene scene;
    scene.period_ns = 1'000'000;
    scene.arms.front().device = "sim";
    scene.paced = scene.restarts = true;
    return session::SharedRun::create("", scene, 8).value();
  }
};

/// The middle of the button that plays and pauses: the third.
ImVec2 play_button() {
  const float side = ImGui::GetFontSize() + 2 * ImGui::GetStyle().FramePadding.y;
  const float width = 1.15F * side + 0.25F * ImGui::GetFontSize();
  return {ImGui::GetStyle().WindowPadding.x + 2.4F * width,
          0.5F * ImGui::GetStyle().WindowPadding.y + 0.5F * side};
}

TEST_F(TimeLineUsed, ButtonPausesTheRunAtItsNewestMoment) {
  ShownRun shown;
  const auto click = [&] {
    for (const bool down : {false, false, true, false}) look(shown.source, play_button(), down);
  };
  click();
  EXPECT_TRUE(shown.reader->pause_asked());
  EXPECT_TRUE(shown.source.head().live());
  click();
  EXPECT_FALSE(shown.reader->pause_asked());
}

TEST_F(TimeLineUsed, ButtonPlaysAnEarlierMoment) {
  ShownRun shown;
  shown.source.head().stop_at(20);
  for (const bool down : {false, false, true, false}) look(shown.source, play_button(), down);
  EXPECT_FALSE(shown.reader->pause_asked());
  EXPECT_TRUE(shown.source.head().plays());
}

TEST_F(TimeLineUsed, KeysMeanTheRunOnlyAtItsNewestMoment) {
  ShownRun shown;
  for (const int key : {GLFW_KEY_SPACE, GLFW_KEY_COMMA, GLFW_KEY_PERIOD}) {
    shown.source.head().to_end();
    EXPECT_FALSE(TimeLine::take_key(key, shown.source)) << key;
    shown.source.head().stop_at(20);
    EXPECT_TRUE(TimeLine::take_key(key, shown.source)) << key;
  }
}

TEST_F(TimeLineUsed, EndedRunIsPlayedFromItsOldestMoment) {
  ShownRun shown;
  shown.run->set_state(session::RunState::kEnded);
  EXPECT_TRUE(TimeLine::take_key(GLFW_KEY_SPACE, shown.source));
  EXPECT_TRUE(shown.source.head().plays());
  EXPECT_EQ(shown.source.head().time(), 10);
}

}  // namespace
}  // namespace thimble::view
