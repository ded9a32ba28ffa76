#include "events/event_watch.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <thread>
#include <vector>

#include "events/event_words.h"
#include "support/heap_guard.h"
#include "thimble/scene/simulated_device.h"

namespace thimble::session {
namespace {

using driver::DeviceStage;
using driver::Fault;

constexpr std::int64_t kPeriod_ns = 1'000'000;

/// Counters that the test sets.
class ScriptedCounters final : public EventCounters {
 public:
  std::uint64_t changes() const noexcept override {
    return std::accumulate(counts.begin(), counts.end(), taken);
  }
  ActivityCounts activities() const noexcept override { return counts; }
  std::uint64_t links_replaced() const noexcept override { return taken; }
  std::array<double, 3> f_wall_W() const noexcept override { return wall_W; }
  std::uint64_t& of(Activity activity) { return counts[static_cast<std::size_t>(activity)]; }

  ActivityCounts counts{};
  std::uint64_t taken = 0;
  std::array<double, 3> wall_W{};
};

/// Run whose ticks are created by the test, 1 ms apart.
class EventWatchTest : public ::testing::Test {
 protected:
  /// Passes the tick `record_` to the watch and starts the next one.
  void tick(std::uint64_t periods = 1) {
    watch_.take(record_);
    record_.tick += 1;
    const auto passed = static_cast<std::int64_t>(periods) * kPeriod_ns;
    record_.time_ns += passed;
    record_.due_ns += passed;
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) tick();
  }

  /// Returns the events so far and clears them.
  std::vector<TickEvent> events() {
    std::vector<TickEvent> got;
    while (ring_.waiting() > 0) {
      const auto front = ring_.front();
      got.insert(got.end(), front.begin(), front.end());
      ring_.drop(front.size());
    }
    return got;
  }

  static TickEvent event(std::uint64_t tick, EventKind kind) {
    return {.tick = tick, .time_ns = static_cast<std::int64_t>(tick) * kPeriod_ns, .kind = kind};
  }
  static TickEvent began(std::uint64_t tick, Activity activity) {
    TickEvent event = EventWatchTest::event(tick, EventKind::kActivityBegan);
    event.activity = activity;
    return event;
  }
  static TickEvent ended(std::uint64_t tick, Activity activity, std::uint64_t count,
                         std::int64_t lasted_ns) {
    TickEvent event = EventWatchTest::event(tick, EventKind::kActivityEnded);
    event.activity = activity;
    event.count = count;
    event.lasted_ns = lasted_ns;
    return event;
  }
  static TickEvent fault(std::uint64_t tick, Fault fault) {
    TickEvent event = EventWatchTest::event(tick, EventKind::kFault);
    event.fault = fault;
    return event;
  }

  using Events = std::vector<TickEvent>;

  ScriptedCounters counters_;
  SpscRing<TickEvent> ring_{64};
  EventWatch watch_{counters_, kPeriod_ns, ring_};
  driver::TickRecord record_;
};

TEST_F(EventWatchTest, ReportsEachStageOnce) {
  ticks(2);
  EXPECT_EQ(events(), Events());
  record_.stage = DeviceStage::kActive;
  ticks(3);
  EXPECT_EQ(events(), Events({event(2, EventKind::kActivated)}));
  record_.stage = DeviceStage::kFault;
  record_.fault = Fault::kOverSpeed;
  ticks(3);
  EXPECT_EQ(events(), Events({fault(5, Fault::kOverSpeed)}));
  record_.fault = Fault::kTransportLost;  // activated and lost again between two ticks
  ticks(2);
  EXPECT_EQ(events(), Events({fault(8, Fault::kTransportLost)}));
  counters_.taken = 1;
  record_.stage = DeviceStage::kActive;
  record_.fault = Fault::kNone;
  ticks(2);
  EXPECT_EQ(events(),
            Events({event(10, EventKind::kLinkReplaced), event(10, EventKind::kActivated)}));
  record_.stage = DeviceStage::kIdle;
  ticks(2);
  EXPECT_EQ(events(), Events({event(12, EventKind::kDeactivated)}));
}

TEST_F(EventWatchTest, ReportsALinkChangeAfterAnotherFault) {
  const auto link = [](std::uint64_t tick, driver::LinkState state) {
    TickEvent event = EventWatchTest::event(tick, EventKind::kLinkChanged);
    event.link = state;
    return event;
  };
  record_.stage = DeviceStage::kFault;
  record_.fault = Fault::kOverSpeed;
  ticks(2);
  events();
  record_.link = driver::LinkState::kLost;
  ticks(2);
  EXPECT_EQ(events(), Events({link(2, driver::LinkState::kLost)}));
  record_.link = driver::LinkState::kSilent;  // state of a new link before its first report
  ticks(2);
  EXPECT_EQ(events(), Events());
  record_.link = driver::LinkState::kConnected;
  ticks(2);
  EXPECT_EQ(events(), Events({link(6, driver::LinkState::kConnected)}));
  record_.fault = Fault::kNoReports;
  record_.link = driver::LinkState::kSilent;
  ticks(2);
  EXPECT_EQ(events(), Events({fault(8, Fault::kNoReports)})) << "which says so itself";
}

TEST_F(EventWatchTest, ReportsAnArmThatIsActiveAtTheFirstTick) {
  record_.stage = DeviceStage::kActive;
  tick();
  EXPECT_EQ(events(), Events({event(0, EventKind::kActivated)}));
}

TEST_F(EventWatchTest, ReportsBeginningAndEndOfAnActivity) {
  ticks(10);
  for (int i = 0; i < 50; ++i) {  // ten occurrences in every other tick
    if (i % 2 == 0) counters_.of(Activity::kRiseCut) += 10;
    tick();
  }
  EXPECT_EQ(events(), Events({began(10, Activity::kRiseCut)}));
  ticks(99);  // the last occurrence was in tick 58
  EXPECT_EQ(events(), Events());
  tick();
  EXPECT_EQ(events(), Events({ended(159, Activity::kRiseCut, 250, 48 * kPeriod_ns)}));
  ticks(300);
  EXPECT_EQ(events(), Events());
  counters_.of(Activity::kRiseCut) += 1;
  tick();
  EXPECT_EQ(events(), Events({began(460, Activity::kRiseCut)}));
}

TEST_F(EventWatchTest, KeepsActivitiesApart) {
  tick();
  for (std::size_t i = 0; i < kActivities; ++i) {
    const auto activity = static_cast<Activity>(i);
    if (activity == Activity::kMissedTicks) continue;
    counters_.of(activity) += 1 + i;
    tick();
    EXPECT_EQ(events(), Events({began(record_.tick - 1, activity)}));
  }
  watch_.finish();
  Events all;
  for (std::size_t i = 0; i < kActivities; ++i) {
    const auto activity = static_cast<Activity>(i);
    if (activity != Activity::kMissedTicks)
      all.push_back(ended(kActivities - 1, activity, 1 + i, 0));
  }
  EXPECT_EQ(events(), all);
  watch_.finish();
  EXPECT_EQ(events(), Events());
}

TEST_F(EventWatchTest, IgnoresCountsFromBeforeItsStart) {
  counters_.of(Activity::kForceCut) = 7;
  counters_.taken = 2;
  EventWatch late(counters_, kPeriod_ns, ring_);
  late.take(record_);
  EXPECT_EQ(events(), Events());
}

TEST_F(EventWatchTest, CountsMissedTicks) {
  tick();
  tick(4);  // three ticks are missed after it
  const std::int64_t missed_at = record_.time_ns;
  tick();
  tick(3);
  tick();
  const auto begun = events();
  ASSERT_EQ(begun.size(), 1u);
  EXPECT_EQ(begun[0].kind, EventKind::kActivityBegan);
  EXPECT_EQ(begun[0].activity, Activity::kMissedTicks);
  EXPECT_EQ(begun[0].tick, 2u);
  EXPECT_EQ(begun[0].time_ns, missed_at);
  watch_.finish();
  const auto over = events();
  ASSERT_EQ(over.size(), 1u);
  EXPECT_EQ(over[0].count, 3u + 2u);
  EXPECT_EQ(over[0].lasted_ns, 4 * kPeriod_ns);
}

TEST_F(EventWatchTest, ReportsTheTouchedObject) {
  tick();
  record_.in_contact = true;
  record_.object = 1;
  ticks(2);
  record_.in_contact = false;
  record_.object = -1;
  ticks(2);
  TickEvent touch = event(1, EventKind::kTouchBegan);
  touch.object = 1;
  EXPECT_EQ(events(), Events({touch, event(3, EventKind::kTouchEnded)}));
}

TEST_F(EventWatchTest, CountsLostEventsAndContinues) {
  SpscRing<TickEvent> small(3);
  EventWatch watch(counters_, kPeriod_ns, small);
  for (int i = 0; i < 10; ++i) {
    record_.in_contact = i % 2 == 0;
    record_.tick = static_cast<std::uint64_t>(i);
    watch.take(record_);
  }
  EXPECT_EQ(watch.lost(), 7u);
  ASSERT_EQ(small.front().size(), 3u);
  EXPECT_EQ(small.front()[2].tick, 2u);  // the oldest are kept
  small.drop(3);
  record_.in_contact = true;
  watch.take(record_);
  EXPECT_EQ(small.waiting(), 1u);
  EXPECT_EQ(watch.lost(), 7u);
}

TEST_F(EventWatchTest, DoesNotAllocate) {
  EXPECT_EQ(support::heap_calls_of([&] {
              for (int i = 0; i < 1000; ++i) {
                counters_.of(Activity::kForceCut) += i % 300 == 0 ? 1 : 0;
                record_.in_contact = i % 200 < 100;
                record_.stage = i % 400 < 200 ? DeviceStage::kActive : DeviceStage::kFault;
                record_.fault = i % 400 < 200 ? Fault::kNone : Fault::kNoReports;
                tick();
              }
            }),
            0);
  EXPECT_GT(ring_.waiting(), 10u);
}

TEST(EventRing, PassesEventsBetweenThreadsInOrder) {
  SpscRing<TickEvent> ring(16);
  constexpr std::uint64_t kEvents = 20'000;
  std::thread servo([&ring] {
    for (std::uint64_t i = 0; i < kEvents;) {
      const TickEvent event{.tick = i, .time_ns = static_cast<std::int64_t>(3 * i), .count = ~i};
      if (ring.push(event)) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t next = 0;
  while (next < kEvents) {
    const auto events = ring.front();
    for (const TickEvent& event : events) {
      ASSERT_EQ(event.tick, next);
      ASSERT_EQ(event.time_ns, static_cast<std::int64_t>(3 * next));
      ASSERT_EQ(event.count, ~next);
      ++next;
    }
    ring.drop(events.size());
    if (events.empty()) std::this_thread::yield();
  }
  servo.join();
  EXPECT_EQ(ring.waiting(), 0u);
}

TEST(EventWords, ContainTickAndTime) {
  const std::vector<std::string> objects{"box", "ball"};
  TickEvent event{.tick = 1234, .time_ns = 1'234'000'000, .kind = EventKind::kFault};
  event.fault = Fault::kOverSpeed;
  EXPECT_EQ(words_of(event, objects), "tick 1234, 1.234 s: Force is off (over_speed). " +
                                          std::string(describe(Fault::kOverSpeed)));
  EXPECT_EQ(level_of(event), spdlog::level::err);
  event.kind = EventKind::kActivityEnded;
  event.activity = Activity::kForceCut;
  event.count = 12;
  event.lasted_ns = 34'000'000;
  EXPECT_EQ(
      words_of(event, objects),
      "tick 1234, 1.234 s: The force was limited to the arm's maximum 12 times within 0.034 s.");
  event.kind = EventKind::kTouchBegan;
  event.object = 1;
  EXPECT_EQ(words_of(event, objects), "tick 1234, 1.234 s: The tip touches ball.");
  event.object = 2;
  EXPECT_EQ(words_of(event, objects), "tick 1234, 1.234 s: The tip touches an object.");
}

TEST(EventWords, WarnWhileAProblemLasts) {
  TickEvent event{.kind = EventKind::kActivityBegan};
  for (const Activity activity : {Activity::kHeat, Activity::kStall, Activity::kRejected,
                                  Activity::kJumped, Activity::kRefused}) {
    event.activity = activity;
    event.kind = EventKind::kActivityBegan;
    EXPECT_EQ(level_of(event), spdlog::level::warn) << words_of(event, {});
    event.kind = EventKind::kActivityEnded;
    EXPECT_EQ(level_of(event), spdlog::level::info) << words_of(event, {});
  }
}

/// Returns the event that a stage changed the force by `percent` percent.
TickEvent changed(std::uint64_t tick, Activity activity, std::uint64_t percent) {
  return {.tick = tick,
          .time_ns = static_cast<std::int64_t>(tick) * kPeriod_ns,
          .count = percent,
          .kind = EventKind::kForceChanged,
          .activity = activity};
}

TEST_F(EventWatchTest, ReportsAStageThatChangesAForceOnce) {
  record_.f_wanted_W = {0, 0, 2};
  record_.f_sent_W = {0, 0, 1.5};
  for (int i = 0; i < 200; ++i) {
    ++counters_.of(Activity::kDamped);
    tick();
  }
  EXPECT_EQ(events(), Events({began(0, Activity::kDamped)}));
  for (int i = 0; i < 1000; ++i) {
    ++counters_.of(Activity::kDamped);
    tick();
  }
  EXPECT_EQ(events(), Events({changed(200, Activity::kDamped, 25)}));
}

TEST_F(EventWatchTest, IgnoresSmallChangesOfAForce) {
  record_.f_wanted_W = {0, 0, 2};
  record_.f_sent_W = {0, 0, 1.81};
  for (int i = 0; i < 1000; ++i) {
    ++counters_.of(Activity::kForceCut);
    tick();
  }
  EXPECT_EQ(events(), Events({began(0, Activity::kForceCut)}));
}

TEST_F(EventWatchTest, TimesAChangeFromItsLastInterruption) {
  record_.f_wanted_W = {0, 0, 2};
  record_.f_sent_W = {0, 0, 1};
  for (int i = 0; i < 1000; ++i) {
    if (i % 150 != 0) ++counters_.of(Activity::kRiseCut);
    tick();
  }
  for (const TickEvent& event : events()) EXPECT_NE(event.kind, EventKind::kForceChanged);
}

TEST_F(EventWatchTest, KeepsTheStrongestForceOfAWall) {
  for (const double force : {1.0, 3.0, 2.0}) {
    counters_.wall_W = {0, -force, 0};
    ++counters_.of(Activity::kWall);
    tick();
  }
  ticks(200);
  TickEvent first = began(0, Activity::kWall);
  first.f_wall_W = {0, -1, 0};
  TickEvent last = ended(103, Activity::kWall, 3, 2 * kPeriod_ns);
  last.f_wall_W = {0, -3, 0};
  EXPECT_EQ(events(), Events({first, last}));
}

TEST_F(EventWatchTest, ComparesForcesOfWallsByTheirNorm) {
  // Each is stronger than the one before it.
  const std::array<std::array<double, 3>, 4> rising{{{0, 1, 0}, {2, 0, 0}, {0, 0, -3}, {2, 2, 2}}};
  for (const auto& force : rising) {
    counters_.wall_W = force;
    ++counters_.of(Activity::kWall);
    tick();
  }
  ticks(200);
  const auto got = events();
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got.back().f_wall_W, rising.back());
  for (std::size_t i = 0; i + 1 < rising.size(); ++i) {
    for (const std::size_t k : {i, i + 1, i}) {
      counters_.wall_W = rising[k];
      ++counters_.of(Activity::kWall);
      tick();
    }
    ticks(200);
    EXPECT_EQ(events().back().f_wall_W, rising[i + 1]) << i;
  }
}

TEST_F(EventWatchTest, ResetsTheWallForceForANewEpisode) {
  for (const double force : {3.0, 1.0}) {
    counters_.wall_W = {force, 0, 0};
    ++counters_.of(Activity::kWall);
    ticks(200);
  }
  const auto got = events();
  ASSERT_EQ(got.size(), 4U);
  EXPECT_EQ(got[3].f_wall_W, (std::array<double, 3>{1, 0, 0}));
}

TEST(EventWords, NameTheWallThatPushes) {
  TickEvent event{.kind = EventKind::kActivityBegan, .activity = Activity::kWall};
  event.f_wall_W = {0, 0.5, 0.1};
  EXPECT_TRUE(is_notice(event));
  EXPECT_EQ(words_of(event, {}),
            "tick 0, 0.000 s: The -y wall of the workspace pushes the tip back.");
  event = {.count = 51, .lasted_ns = 50'000'000, .kind = EventKind::kActivityEnded};
  event.activity = Activity::kWall;
  event.f_wall_W = {-3, 0, 0};
  EXPECT_EQ(words_of(event, {}),
            "tick 0, 0.000 s: The walls of the workspace pushed in 51 ticks within 0.050 s, with "
            "3.00 N at most (+x wall).");
}

TEST(EventWords, NameTheStageThatChangedAForce) {
  for (std::size_t i = 0; i < kActivities; ++i) {
    const auto activity = static_cast<Activity>(i);
    if (!changes_force(activity)) continue;
    const TickEvent event = changed(7, activity, 30);
    EXPECT_TRUE(is_notice(event));
    const std::string words = words_of(event, {});
    EXPECT_NE(words.find("30 %"), std::string::npos) << words;
    EXPECT_EQ(words.find("A stage of the gate"), std::string::npos) << words;
  }
}

TEST(DeviceCounters, CountStallsOfTheLoop) {
  auto opened =
      scene::SimulatedDevice::open("vintage_phantom", {{0.0, {0, 0, 0}}, {1.0, {0, 0, 0}}});
  ASSERT_TRUE(opened) << opened.error().message;
  const DeviceCounters counters((*opened)->device());
  const auto stalls = [&counters] {
    return counters.activities()[static_cast<std::size_t>(Activity::kStall)];
  };
  ASSERT_TRUE((*opened)->device().activate());
  // A tick takes three times as long as the loop may be late.
  driver::VirtualClock& clock = (*opened)->clock();
  auto law = [&clock](const driver::DeviceState& state) noexcept {
    if (state.tick == 10) clock.sleep_until_ns(clock.now_ns() + 60'000'000);
    return driver::ForceCommand();
  };
  auto sink = [](const driver::TickRecord&) noexcept {};
  EXPECT_EQ(stalls(), 0U);
  (*opened)->run(0.2, law, sink);
  EXPECT_EQ(stalls(), 1U);
}

}  // namespace
}  // namespace thimble::session
