#include "view/playback/play_head.h"

#include <gtest/gtest.h>

namespace thimble::view {
namespace {

TEST(PlayHead, RecordingPlaysAtSetSpeedAndStopsAtTheEnd) {
  PlayHead head = PlayHead::of_recording();
  head.set_span(3, 5);
  EXPECT_TRUE(head.plays());
  EXPECT_EQ(head.time(), 3);
  head.step(0.5);
  EXPECT_DOUBLE_EQ(head.time(), 3.5);
  head.set_speed(0.1);
  head.step(1);
  EXPECT_DOUBLE_EQ(head.time(), 3.6);
  head.set_speed(1000);
  EXPECT_EQ(head.speed(), PlayHead::kFastest);
  head.step(10);
  EXPECT_EQ(head.time(), 5);
  EXPECT_FALSE(head.plays());
  EXPECT_FALSE(head.live());
  head.toggle();  // again from the start
  EXPECT_EQ(head.time(), 3);
  EXPECT_TRUE(head.plays());
}

TEST(PlayHead, PositionIsClampedToTheSpan) {
  PlayHead head = PlayHead::of_recording();
  head.set_span(0, 2);
  head.stop_at(1.25);
  head.step(10);
  EXPECT_EQ(head.time(), 1.25);
  head.go(-4);
  EXPECT_EQ(head.time(), 0);
  head.to_end();
  EXPECT_EQ(head.time(), 2);
}

TEST(PlayHead, FollowsRunUntilMovedBack) {
  PlayHead head = PlayHead::of_run();
  for (int i = 1; i < 5; ++i) {
    head.set_span(0, i);
    head.step(0.1);
    EXPECT_TRUE(head.live());
    EXPECT_EQ(head.time(), i);
    EXPECT_EQ(head.behind(), 0);
  }
  head.go(1.5);
  head.set_span(0, 8);  // the run continues
  head.step(0.1);
  EXPECT_FALSE(head.live());
  EXPECT_EQ(head.time(), 1.5);
  EXPECT_EQ(head.behind(), 6.5);
  head.set_span(2, 10);  // the displayed moment is no longer stored
  EXPECT_EQ(head.time(), 2);
  head.to_end();
  EXPECT_TRUE(head.live());
  head.set_span(2, 11);
  EXPECT_EQ(head.time(), 11);
}

TEST(PlayHead, RunIsLiveAgainAfterCatchingUp) {
  PlayHead head = PlayHead::of_run();
  head.set_span(0, 4);
  head.toggle();  // holds this moment
  EXPECT_FALSE(head.live());
  head.set_span(0, 6);
  EXPECT_EQ(head.time(), 4);
  head.toggle();
  head.set_speed(4);
  head.step(0.25);
  EXPECT_EQ(head.time(), 5);
  head.step(0.25);
  EXPECT_TRUE(head.live());
}

}  // namespace
}  // namespace thimble::view
