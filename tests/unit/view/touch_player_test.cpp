#include "view/feedback/touch_player.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "share/shared_run.h"
#include "support/scratch.h"
#include "view/feedback/rumble.h"

namespace thimble::view {
namespace {

driver::TickRecord touching(double force, std::int64_t ms = 0) {
  driver::TickRecord tick;
  tick.time_ns = 1'000'000 * ms;
  tick.f_sent_W = {0, 0, force};
  tick.n_W = {0, 0, 1};
  tick.in_contact = true;
  return tick;
}

TEST(RumbleOf, IsTheForceOfTheTouchWithinItsBounds) {
  const std::vector<driver::TickRecord> ticks{touching(1), touching(1.1)};
  const RumbleLevel level = rumble_of(ticks, 4);
  EXPECT_NEAR(level.strong, 1.1 / 4, 1e-12);
  EXPECT_NEAR(level.weak, 0.1 / 0.5, 1e-12);
  const std::vector<driver::TickRecord> hard{touching(-100), touching(100)};
  EXPECT_EQ(rumble_of(hard, 4), (RumbleLevel{1, 1}));
}

TEST(RumbleOf, IsZeroWithoutContactOrForNaN) {
  std::vector<driver::TickRecord> ticks{touching(3), touching(1)};
  for (driver::TickRecord& tick : ticks) tick.in_contact = false;
  EXPECT_EQ(rumble_of(ticks, 4), RumbleLevel{});
  EXPECT_EQ(rumble_of({}, 4), RumbleLevel{});
  const std::vector<driver::TickRecord> nonsense{touching(std::nan("")), touching(std::nan(""))};
  EXPECT_EQ(rumble_of(nonsense, 4), RumbleLevel{});
}

/// The output of a player, and the run that it plays.
class TouchPlayerTest : public ::testing::Test {
 protected:
  struct Sound final : SoundOutput {
    explicit Sound(std::vector<float>& to) : heard(to) {}
    void play(std::span<const float> samples) override {
      heard.insert(heard.end(), samples.begin(), samples.end());
    }
    std::vector<float>& heard;
  };
  struct Rumble final : RumbleOutput {
    explicit Rumble(std::vector<RumbleLevel>& to) : felt(to) {}
    void rumble(const RumbleLevel& level) override { felt.push_back(level); }
    std::vector<RumbleLevel>& felt;
  };

  void join(bool wall_clock, bool paced = false) {
    session::SharedScene scene;
    scene.name = "felt";
    scene.period_ns = 1'000'000;
    scene.force_max = 4;
    scene.wall_clock = wall_clock;
    scene.paced = paced;
    scene.arms.front().device = "sim";
    run_ = session::SharedRun::create("", scene, 1000).value();
    reader_ = session::SharedReader::over(run_->memory().again().value()).value();
    run_->set_state(session::RunState::kRunning);
    player_ = std::make_unique<TouchPlayer>(std::make_unique<Sound>(heard_),
                                            std::make_unique<Rumble>(felt_));
  }
  /// Runs for `ms` with a force, then updates the player.
  void go_on(int ms, double force) {
    for (int i = 0; i < ms; ++i) run_->store_tick(touching(force, tick_++));
    look(ms);
  }
  void look(int ms) {
    now_ns_ += 1'000'000LL * ms;
    player_->step(*reader_, now_ns_);
  }

  std::unique_ptr<session::SharedRun> run_;
  std::unique_ptr<session::SharedReader> reader_;
  std::unique_ptr<TouchPlayer> player_;
  std::vector<float> heard_;
  std::vector<RumbleLevel> felt_;
  std::int64_t tick_ = 0;
  std::int64_t now_ns_ = 5'000'000'000;
};

TEST_F(TouchPlayerTest, PlaysOnlyTicksAfterItsStart) {
  join(true);
  for (int i = 0; i < 50; ++i) run_->store_tick(touching(2, tick_++));
  player_->begin(*reader_);
  look(10);
  EXPECT_TRUE(heard_.empty()) << "earlier ticks are not played";
  EXPECT_TRUE(felt_.empty());
  go_on(20, 2);
  EXPECT_EQ(heard_.size(), 20U * 48U);
  ASSERT_EQ(felt_.size(), 1U);
  EXPECT_EQ(felt_[0].strong, 0.5);
}

TEST_F(TouchPlayerTest, UpdatesGamepadEvery50To100ms) {
  join(true);
  player_->begin(*reader_);
  for (int i = 0; i < 100; ++i) go_on(10, 2);
  // One second: at least every 100 ms, at most every 50 ms.
  EXPECT_GE(felt_.size(), 10U);
  EXPECT_LE(felt_.size(), 21U);
}

TEST_F(TouchPlayerTest, StopsTheGamepadWhenTheRunStallsPausesOrEnds) {
  join(true);
  player_->begin(*reader_);
  go_on(10, 2);
  look(190);
  EXPECT_NE(felt_.back(), RumbleLevel{}) << "the last update is less than 0.2 s old";
  look(20);
  EXPECT_EQ(felt_.back(), RumbleLevel{});
  const std::size_t sent_before = felt_.size();
  look(500);
  EXPECT_EQ(felt_.size(), sent_before) << "updated once";
  for (const session::RunState state : {session::RunState::kPaused, session::RunState::kEnded}) {
    run_->set_state(session::RunState::kRunning);
    go_on(60, 2);
    EXPECT_NE(felt_.back(), RumbleLevel{});
    run_->set_state(state);
    go_on(10, 2);
    EXPECT_EQ(felt_.back(), RumbleLevel{});
  }
}

TEST_F(TouchPlayerTest, StopsTheGamepadWhenNothingTouches) {
  join(true);
  player_->begin(*reader_);
  go_on(10, 2);
  driver::TickRecord free = touching(0, tick_++);
  free.in_contact = false;
  run_->store_tick(free);
  look(1);
  EXPECT_EQ(felt_.back(), RumbleLevel{});
}

TEST_F(TouchPlayerTest, PlaysPacedRunOnlyAtRealTimeSpeed) {
  join(false, true);
  player_->begin(*reader_);
  go_on(20, 2);
  EXPECT_EQ(heard_.size(), 20U * 48U);
  EXPECT_EQ(felt_.size(), 1U);
  ASSERT_TRUE(reader_->ask_speed(0.5));
  heard_.clear();
  for (int i = 0; i < 10; ++i) go_on(20, 2);
  EXPECT_TRUE(heard_.empty()) << "half as many samples as the card plays";
  EXPECT_GT(felt_.size(), 1U) << "a gamepad is updated at any pace";
}

TEST_F(TouchPlayerTest, DoesNotPlayRunsInVirtualTime) {
  join(false);
  player_->begin(*reader_);
  go_on(100, 2);
  EXPECT_TRUE(heard_.empty());
  EXPECT_TRUE(felt_.empty());
}

TEST(Rumble, ErrorNamesTheRemedyWithoutGamepad) {
  const auto opened = open_rumble(support::scratch_folder());
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().message,
            "No rumble: no gamepad with rumble is plugged in. Plug one in and start again.");
}

}  // namespace
}  // namespace thimble::view
