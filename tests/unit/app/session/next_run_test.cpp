#include "share/steer/next_run.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "setup.h"
#include "share/shared_reader.h"
#include "share/shared_run.h"
#include "share/steer/file_watch.h"
#include "share/viewer_request_handler.h"
#include "speed_clock.h"
#include "support/run_hash.h"
#include "support/scratch.h"
#include "text_file.h"
#include "thimble/scene/arm_file.h"

namespace thimble::session {
namespace {

const std::filesystem::path kSource(THIMBLE_SOURCE_DIR);
const std::atomic<bool> kNeverStop{false};

/// Run of a copy of the rubber ball's scene file, with viewers in this process.
class NextRunTest : public ::testing::Test {
 protected:
  NextRunTest() {
    file_ = support::scratch_folder() / "ball.yaml";
    write("400");
    options_.duration = 0.8;
    options_.clock = ClockKind::kPaced;
    options_.share = true;
    options_.restarts = true;
  }

  /// Writes the scene with the given stiffness (N/m).
  void write(const std::string& stiffness) {
    std::string text = scene::text_of(kSource / "app/scenes/rubber.yaml");
    text.replace(text.find("400"), 3, stiffness);
    std::ofstream(file_) << text;
  }

  std::unique_ptr<Session> prepare() const { return Session::prepare(file_, options_).value(); }

  NextRun next_of(bool reload = false, bool loop = false, double speed = 4) const {
    return {[this](const std::filesystem::path& scene) { return prepare_unseen(scene); }, reload,
            loop, speed};
  }

  /// Prepares the next run, not yet visible to viewers.
  driver::Result<std::unique_ptr<Session>> prepare_unseen(
      const std::filesystem::path& scene) const {
    SessionOptions unseen = options_;
    unseen.share = false;
    return Session::prepare(scene, unseen);
  }

  static std::unique_ptr<SharedReader> view(Session& session) {
    return SharedReader::over(session.shared()->memory().again().value()).value();
  }

  static std::uint64_t hash_of(const Session& session) {
    support::RunHash hash;
    for (const auto& row : session.ticks()) hash.add(row);
    return hash.value();
  }

  /// Returns the ticks of a run in virtual time without viewers.
  std::uint64_t hash_alone() const {
    SessionOptions alone;
    alone.duration = options_.duration;
    const auto session = Session::open(file_, alone).value();
    session->run();
    return hash_of(*session);
  }

  std::filesystem::path file_;
  SessionOptions options_;
};

TEST_F(NextRunTest, RestartIsBitIdentical) {
  const std::uint64_t fresh = hash_alone();
  NextRun next = next_of();
  auto session = prepare();
  next.begin(*session);
  ASSERT_TRUE(session->open_arm());
  for (int i = 0; i < 30; ++i) ASSERT_FALSE(session->step(next.ended()));
  ASSERT_TRUE(view(*session)->ask_restart());
  next.step(false);
  EXPECT_TRUE(next.ended());
  EXPECT_EQ(session->run(next.ended()), driver::ServoEnd::kStopped);
  auto again = next.take(driver::ServoEnd::kStopped, false);
  ASSERT_TRUE(again);
  session = std::move(again);
  ASSERT_TRUE(session->share(options_));
  next.begin(*session);
  EXPECT_FALSE(next.ended());
  EXPECT_EQ(view(*session)->speed_asked(), 4) << "the chosen speed is kept";
  ASSERT_TRUE(session->open_arm());
  EXPECT_EQ(session->run(next.ended()), driver::ServoEnd::kDone);
  EXPECT_EQ(hash_of(*session), fresh);
  EXPECT_FALSE(next.take(driver::ServoEnd::kDone, false)) << "it does not loop";
}

TEST_F(NextRunTest, AnySpeedAndSingleStepsAreBitIdentical) {
  const std::uint64_t fresh = hash_alone();
  NextRun next = next_of();
  const auto session = prepare();
  next.begin(*session);
  const auto viewer = view(*session);
  ASSERT_TRUE(session->open_arm());
  EXPECT_FALSE(viewer->ask_steps(1)) << "it is not paused";
  viewer->ask_pause(true);
  std::thread servo([&] { session->run(next.ended()); });
  // The test waits in wall time but does not measure it.
  const auto wait_for = [](auto condition) {
    while (!condition()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  wait_for([&] { return viewer->state() == RunState::kPaused; });
  const std::uint64_t stood = viewer->counters().ticks;
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_EQ(viewer->counters().ticks, stood) << "simulated time stops";
  for (const std::uint64_t ticks : {1u, 10u, 100u}) {
    const std::uint64_t before = viewer->counters().ticks;
    EXPECT_TRUE(viewer->ask_steps(ticks));
    wait_for([&] { return viewer->counters().ticks >= before + ticks; });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(viewer->counters().ticks, before + ticks);
    EXPECT_EQ(viewer->state(), RunState::kPaused);
  }
  // An implausible number of steps, as another program might write.
  auto& live = *reinterpret_cast<SharedLive*>(session->shared()->memory().bytes().data() +
                                              kSharedLiveOffset);
  const std::uint64_t before = viewer->counters().ticks;
  live.requests.steps.fetch_add(1'000'000'000);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_EQ(viewer->counters().ticks, before);
  EXPECT_EQ(viewer->counters().missed, 0u) << "a stopped run misses no ticks";
  EXPECT_EQ(viewer->counters().paused, 0u);
  viewer->ask_pause(false);
  EXPECT_TRUE(viewer->ask_speed(2));
  EXPECT_TRUE(viewer->ask_speed(1000));
  EXPECT_EQ(viewer->speed_asked(), kSpeedMax);
  servo.join();
  EXPECT_EQ(viewer->counters().missed, 0u);
  EXPECT_EQ(hash_of(*session), fresh);
}

TEST_F(NextRunTest, ReloadsAChangedFileUnlessItIsInvalid) {
  NextRun next = next_of(true);
  const auto session = prepare();
  next.begin(*session);
  const auto viewer = view(*session);
  const auto look = [&] {
    for (int i = 0; i <= FileWatch::kSettled; ++i) next.step(false);
  };
  look();
  EXPECT_FALSE(next.ended()) << "nothing has changed";
  write("stiff");
  look();
  EXPECT_FALSE(next.ended()) << "the run continues";
  EXPECT_NE(viewer->notice().find("ball.yaml:15: stiffness: expected"), std::string::npos)
      << viewer->notice();
  write("400");
  look();
  EXPECT_FALSE(next.ended()) << "that runs already";
  EXPECT_EQ(viewer->notice(), "");
  write("300");
  look();
  EXPECT_TRUE(next.ended());
  const auto changed = next.take(driver::ServoEnd::kStopped, false);
  ASSERT_TRUE(changed);
  EXPECT_EQ(changed->scene().objects[0].stiffness, 300);
}

TEST_F(NextRunTest, RunsAnotherSceneOrReportsTheError) {
  NextRun next = next_of();
  const auto session = prepare();
  next.begin(*session);
  const auto viewer = view(*session);
  ASSERT_TRUE(viewer->ask_restart("/nowhere/none.yaml"));
  next.step(false);
  EXPECT_FALSE(next.ended());
  EXPECT_NE(viewer->notice().find("/nowhere/none.yaml"), std::string::npos) << viewer->notice();
  EXPECT_FALSE(viewer->ask_restart(std::string(5000, 'x'))) << "the path is too long";
  ASSERT_TRUE(viewer->ask_restart((kSource / "app/scenes/honey.yaml").string()));
  next.step(false);
  EXPECT_TRUE(next.ended());
  const auto honey = next.take(driver::ServoEnd::kStopped, false);
  ASSERT_TRUE(honey);
  EXPECT_EQ(honey->scene().name, "honey");
}

TEST_F(NextRunTest, LoopsOnlyOnceFromEachRun) {
  NextRun next = next_of(false, true);
  const auto session = prepare();
  next.begin(*session);
  ASSERT_TRUE(next.take(driver::ServoEnd::kDone, false));
  EXPECT_FALSE(next.take(driver::ServoEnd::kDone, false)) << "the next run has not begun";
}

TEST_F(NextRunTest, LoopContinuesWithTheLastGoodScene) {
  for (const ClockKind clock : {ClockKind::kPaced, ClockKind::kVirtual, ClockKind::kWall}) {
    write("300");
    options_.clock = clock;
    const std::uint64_t fresh = hash_alone();
    NextRun next = next_of(true, true);
    auto session = prepare();
    next.begin(*session);
    write("stiff");
    for (int run = 0; run < 2; ++run) {
      auto again = next.take(driver::ServoEnd::kDone, false);
      ASSERT_TRUE(again) << "run " << run;
      ASSERT_TRUE(again->share(options_, session->shared()));
      next.begin(*again);
      EXPECT_NE(view(*again)->notice().find("ball.yaml:15: stiffness: expected"), std::string::npos)
          << view(*again)->notice();
      session = std::move(again);
    }
    if (clock != ClockKind::kWall) {
      ASSERT_TRUE(session->open_arm());
      EXPECT_EQ(session->run(next.ended()), driver::ServoEnd::kDone);
      EXPECT_EQ(hash_of(*session), fresh);
    }
    write("250");
    const auto repaired = next.take(driver::ServoEnd::kDone, false);
    ASSERT_TRUE(repaired);
    EXPECT_EQ(repaired->scene().objects[0].stiffness, 250);
  }
}

TEST_F(NextRunTest, HandlerWithoutANextRunServesRecordings) {
  const auto session = prepare();
  ViewerRequestHandler handler(*session, nullptr, false);
  handler.step();
  EXPECT_FALSE(handler.ended());
  handler.close();
  EXPECT_EQ(view(*session)->notice(), "") << "no recording was requested";
}

TEST_F(NextRunTest, ViewersKeepTheLastEightSeconds) {
  const auto session = prepare();
  const auto& head =
      *reinterpret_cast<const SharedHead*>(session->shared()->memory().bytes().data());
  EXPECT_EQ(head.ring.count, 8 * static_cast<std::uint64_t>(session->scene().rate));
}

TEST_F(NextRunTest, KeepsRequestsMadeDuringPreparation) {
  std::unique_ptr<SharedReader> viewer;
  std::string asked_meanwhile = (kSource / "app/scenes/honey.yaml").string();
  int prepared = 0;
  NextRun next(
      [&](const std::filesystem::path& scene) {
        ++prepared;
        auto session = prepare_unseen(scene);
        // While the ball is prepared, a viewer sends another request.
        if (prepared == 1) {
          EXPECT_TRUE(viewer->ask_restart(asked_meanwhile));
          EXPECT_TRUE(viewer->ask_loop(true));
          EXPECT_TRUE(viewer->ask_speed(0.5));
        }
        return session;
      },
      false, false, 4);
  const auto session = prepare();
  viewer = view(*session);
  next.begin(*session);
  ASSERT_TRUE(viewer->ask_restart());
  next.step(false);
  EXPECT_TRUE(next.ended());
  EXPECT_EQ(prepared, 2) << "prepared while the run continues";
  // The servo may continue for a while; requests to it would be lost now.
  EXPECT_FALSE(viewer->check_accepted());
  const auto late = viewer->ask_restart();
  ASSERT_FALSE(late);
  EXPECT_NE(late.error().message.find("try again"), std::string::npos) << late.error().message;
  const auto then = next.take(driver::ServoEnd::kStopped, false);
  ASSERT_TRUE(then);
  EXPECT_EQ(then->scene().name, "honey");
  EXPECT_EQ(prepared, 2);
  ASSERT_TRUE(then->share(options_, session->shared()));
  next.begin(*then);
  const auto anew = view(*then);
  EXPECT_TRUE(anew->check_accepted());
  EXPECT_TRUE(anew->loop_asked());
  EXPECT_EQ(anew->speed_asked(), 0.5);
  EXPECT_EQ(anew->notice(), "");
}

TEST_F(NextRunTest, ReportsARejectedSceneToViewersOfTheNextRun) {
  std::unique_ptr<SharedReader> viewer;
  bool first = true;
  NextRun next(
      [&](const std::filesystem::path& scene) {
        if (first) {
          EXPECT_TRUE(viewer->ask_restart("/nowhere/none.yaml"));
        }
        first = false;
        return prepare_unseen(scene);
      },
      false, false, 4);
  const auto session = prepare();
  viewer = view(*session);
  next.begin(*session);
  ASSERT_TRUE(viewer->ask_restart());
  next.step(false);
  const auto then = next.take(driver::ServoEnd::kStopped, false);
  ASSERT_TRUE(then) << "the previous request is prepared";
  ASSERT_TRUE(then->share(options_));
  next.begin(*then);
  EXPECT_NE(view(*then)->notice().find("/nowhere/none.yaml"), std::string::npos);
}

TEST_F(NextRunTest, HandlesRequestsAfterTheLastTick) {
  NextRun next = next_of();
  auto session = prepare();
  auto viewer = view(*session);
  next.begin(*session);
  ASSERT_TRUE(viewer->ask_restart());
  const auto again = next.take(driver::ServoEnd::kDone, false);
  ASSERT_TRUE(again) << "requested after the last check during the run";
  EXPECT_FALSE(viewer->ask_restart());

  session = prepare();
  viewer = view(*session);
  next.begin(*session);
  ASSERT_TRUE(viewer->ask_loop(true));
  viewer->ask_stop();
  EXPECT_FALSE(next.take(driver::ServoEnd::kDone, false)) << "a viewer has ended it";

  session = prepare();
  viewer = view(*session);
  next.begin(*session);
  ASSERT_TRUE(viewer->ask_restart());
  EXPECT_FALSE(next.take(driver::ServoEnd::kFault, false));
  EXPECT_NE(viewer->notice().find("fault"), std::string::npos) << viewer->notice();
}

TEST_F(NextRunTest, PauseCarriesOverToTheNextRun) {
  NextRun next = next_of(false, true);
  const auto session = prepare();
  next.begin(*session);
  view(*session)->ask_pause(true);
  const auto then = next.take(driver::ServoEnd::kDone, false);
  ASSERT_TRUE(then);
  ASSERT_TRUE(then->share(options_, session->shared()));
  next.begin(*then);
  EXPECT_TRUE(view(*then)->pause_asked());
  ASSERT_TRUE(view(*then)->ask_restart());
  next.step(false);
  const auto anew = next.take(driver::ServoEnd::kStopped, false);
  ASSERT_TRUE(anew);
  ASSERT_TRUE(anew->share(options_, then->shared()));
  next.begin(*anew);
  EXPECT_FALSE(view(*anew)->pause_asked()) << "a restart ends the pause";
}

TEST_F(NextRunTest, KeepsASpeedRequestedBeforeTheStart) {
  NextRun next = next_of(false, false, 4);
  const auto session = prepare();
  const auto viewer = view(*session);
  ASSERT_TRUE(viewer->ask_speed(0.25));
  ASSERT_TRUE(viewer->ask_loop(true));
  next.begin(*session);
  EXPECT_EQ(viewer->speed_asked(), 0.25);
  EXPECT_TRUE(viewer->loop_asked());
}

TEST_F(NextRunTest, LoopsUntilAFaultOrAStop) {
  NextRun next = next_of(false, true);
  const auto session = prepare();
  const auto viewer = view(*session);
  next.begin(*session);
  EXPECT_TRUE(viewer->loop_asked());
  EXPECT_FALSE(next.take(driver::ServoEnd::kDone, true)) << "Ctrl-C was pressed";
  EXPECT_FALSE(next.take(driver::ServoEnd::kFault, false)) << "after a fault a person looks first";
  next.begin(*session);
  EXPECT_TRUE(next.take(driver::ServoEnd::kDone, false));
  const auto again = prepare();
  next.begin(*again);
  ASSERT_TRUE(view(*again)->ask_loop(false));
  EXPECT_FALSE(next.take(driver::ServoEnd::kDone, false));
  EXPECT_FALSE(next.ended());
  next.begin(*again);
  next.step(true);
  EXPECT_TRUE(next.ended());
}

TEST_F(NextRunTest, NeverRestartsARealArm) {
  RealArmUse use;
  use.arm.kind = driver::ArmKind::kPolhem;
  use.arm.serial = "on_the_desk";
  use.terms.arm.path = kSource / "app/arms/vintage_phantom.yaml";
  use.terms.arm.file = scene::load_arm(use.terms.arm.path).value();
  use.terms.max_force = 1;
  options_.real_arms["right"] = std::move(use);
  options_.several_arms = true;
  const auto session = Session::prepare(kSource / "app/scenes/two_hands.yaml", options_).value();
  const auto viewer = view(*session);
  EXPECT_FALSE(session->setup().paced());
  for (const auto& refused : {viewer->ask_restart(), viewer->ask_loop(true), viewer->ask_speed(2),
                              viewer->ask_steps(1)}) {
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("physical arm"), std::string::npos);
  }
  // Whatever the memory contains.
  auto& live = *reinterpret_cast<SharedLive*>(session->shared()->memory().bytes().data() +
                                              kSharedLiveOffset);
  NextRun next = next_of(true, true);
  next.begin(*session);
  live.requests.restart.store({.number = 7, .scene = {}});
  live.requests.loop.store(1);
  for (int i = 0; i < 5; ++i) next.step(false);
  EXPECT_FALSE(next.ended());
  EXPECT_FALSE(next.take(driver::ServoEnd::kDone, false));
}

TEST(FileWatch, ReportsAFileOnceItIsStableAndDifferent) {
  const auto file = support::scratch_folder() / "watched.yaml";
  const auto write = [&file](const char* text) { std::ofstream(file) << text; };
  write("one");
  FileWatch watch({file, {}});
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(watch.step());
  write("one and more");
  EXPECT_FALSE(watch.step()) << "it may be written to still";
  write("one and more yet");
  EXPECT_FALSE(watch.step());
  EXPECT_FALSE(watch.step());
  EXPECT_TRUE(watch.step());
  EXPECT_FALSE(watch.step()) << "reported once";
  EXPECT_FALSE(watch.as_at_first());
  std::filesystem::remove(file);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(watch.step()) << "an editor puts it back";
  write("one");
  EXPECT_FALSE(watch.step());
  EXPECT_FALSE(watch.step());
  EXPECT_TRUE(watch.step());
  EXPECT_TRUE(watch.as_at_first());
}

TEST(SpeedClock, FollowsRealTimeTimesSpeedAndCatchesUpALittle) {
  constexpr double kMillisecond = 1e6;
  EXPECT_EQ(paced_due(100 * kMillisecond, 100 * kMillisecond, kMillisecond, 1), 101 * kMillisecond);
  EXPECT_EQ(paced_due(100 * kMillisecond, 100 * kMillisecond, kMillisecond, 4),
            100.25 * kMillisecond);
  EXPECT_EQ(paced_due(100 * kMillisecond, 100 * kMillisecond, kMillisecond, 0.1),
            110 * kMillisecond);
  EXPECT_EQ(paced_due(100 * kMillisecond, 120 * kMillisecond, kMillisecond, 1), 101 * kMillisecond)
      << "late, and runs after it";
  EXPECT_EQ(paced_due(100 * kMillisecond, 1000 * kMillisecond, kMillisecond, 1), 950 * kMillisecond)
      << "too late for that";
  SpeedClock clock;
  clock.sleep_until_ns(1000);
  EXPECT_EQ(clock.now_ns(), 1000) << "never later than requested: no tick is missed";
  clock.sleep_until_ns(500);
  EXPECT_EQ(clock.now_ns(), 1000);
}

}  // namespace
}  // namespace thimble::session
