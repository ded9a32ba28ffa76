// Updates for the pages of a live run, without a network.
#include "web/live_feed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <string>

#include "live_updates.h"
#include "mesh/contact_mesh.h"
#include "share/shared_run.h"

namespace thimble::web {
namespace {

class LiveFeedTest : public ::testing::Test {
 protected:
  LiveFeedTest()
      : run_(session::SharedRun::create("", live_scene(), 2000).value()),
        reader_(session::SharedReader::over(run_->memory().again().value()).value()),
        feed_(std::make_unique<LiveFeed>(*reader_)) {
    run_->set_state(session::RunState::kRunning);
  }

  void run_ticks(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) run_->store_tick(live_tick(next_++));
  }
  /// Reads all available messages for a page.
  std::string all(LiveFeed::Place& place) const {
    std::string bytes;
    while (feed_->has_message(place)) bytes += feed_->message(place);
    return bytes;
  }

  std::unique_ptr<session::SharedRun> run_;
  std::unique_ptr<session::SharedReader> reader_;
  std::unique_ptr<LiveFeed> feed_;
  std::uint64_t next_ = 0;
};

using driver::TickRecord;

std::vector<std::uint32_t> from_to(std::uint32_t begin, std::uint32_t end) {
  std::vector<std::uint32_t> all(end - begin);
  std::iota(all.begin(), all.end(), begin);
  return all;
}

TEST_F(LiveFeedTest, EveryTickReachesAPageOnceUnchanged) {
  LiveFeed::Place place;
  std::string reported;
  for (const std::size_t count : {1U, 33U, 0U, 40U, 1U}) {
    run_ticks(count);
    feed_->step();
    reported += all(place);
  }
  EXPECT_EQ(ticks_of(reported), from_to(0, 75));
  for (const LiveUpdate& update : updates_of(reported)) {
    const auto ticks = update.array<std::uint32_t>("arm0.tick");
    const auto times = update.array<double>("arm0.t");
    const auto sent = update.array<float>("arm0.sent");
    const auto periods = update.array<float>("arm0.period");
    ASSERT_EQ(times.size(), ticks.size());
    ASSERT_EQ(sent.size(), 3 * ticks.size());
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      EXPECT_NEAR(times[i], 1e-3 * ticks[i], 1e-12);
      EXPECT_EQ(sent[3 * i + 2], static_cast<float>(1e-3 * ticks[i]));
      if (ticks[i] > 0) {
        EXPECT_FLOAT_EQ(periods[i], 1e-3F) << ticks[i];
      }
    }
  }
}

TEST_F(LiveFeedTest, EveryBodyReachesAPage) {
  LiveFeed::Place place;
  run_ticks(5);
  session::ScenePoses poses;
  poses.count = 2;  // all objects of the scene
  for (std::size_t i = 0; i < poses.count; ++i) {
    poses.object[i] = static_cast<std::int32_t>(i);
    poses.pose[i].p_WB = {static_cast<double>(i), 0.5, 0};
    poses.pose[i].q_WB = {0, 0, 0, 1};
  }
  run_->store_poses(poses);
  feed_->step();
  bool found = false;
  for (const LiveUpdate& update : updates_of(all(place))) {
    const auto seen = update.array<float>("bodies.poses");
    if (seen.empty()) continue;
    found = true;
    EXPECT_EQ(update.json["bodies"]["objects"], nlohmann::json({0, 1}));
    ASSERT_EQ(seen.size(), 14U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(seen[7 * i], static_cast<float>(i));
      EXPECT_EQ(seen[7 * i + 1], 0.5F);
      EXPECT_EQ(seen[7 * i + 6], 1);
    }
  }
  EXPECT_TRUE(found);
}

TEST_F(LiveFeedTest, LatePageGetsTheStoredUpdates) {
  LiveFeed::Place early, late;
  for (int update = 0; update < 5; ++update) {
    run_ticks(20);
    feed_->step();
    all(early);
  }
  EXPECT_EQ(ticks_of(all(late)), from_to(0, 100));
  EXPECT_FALSE(feed_->has_message(late));
}

TEST_F(LiveFeedTest, SlowPageLearnsHowManyTicksItMissed) {
  LiveFeed::Place slow;
  run_ticks(500);
  feed_->step();
  std::string reported = all(slow);
  for (int update = 0; update < 70; ++update) {
    run_ticks(1000);
    feed_->step();
  }
  // Stored updates are bounded, however long the page is disconnected.
  EXPECT_LE(feed_->end() - feed_->oldest(), 61U);
  EXPECT_EQ(feed_->lost(), 0U);
  const std::string rest = all(slow);
  std::uint64_t lost = 0;
  for (const LiveUpdate& update : updates_of(rest)) lost += update.json.value("lost_here", 0U);
  EXPECT_EQ(lost, 10'000U);
  reported += rest;
  EXPECT_EQ(ticks_of(reported).size() + lost, 70'500U);
  EXPECT_EQ(ticks_of(rest), from_to(10'500, 70'500));
}

TEST_F(LiveFeedTest, AMessageToASlowPageIsBounded) {
  LiveFeed::Place slow;
  for (int update = 0; update < 20; ++update) {
    run_ticks(1000);
    feed_->step();
  }
  std::size_t messages = 0;
  while (feed_->has_message(slow)) {
    EXPECT_LE(feed_->message(slow).size(), LiveFeed::kMessageBytes + 100'000);
    ++messages;
  }
  EXPECT_GT(messages, 3U);
}

TEST_F(LiveFeedTest, ReportsOverwrittenTicks) {
  LiveFeed::Place place;
  run_ticks(1);
  feed_->step();
  run_ticks(5000);  // the ring has 2000 entries
  feed_->step();
  EXPECT_EQ(feed_->lost(), 3000U);
  const auto updates = updates_of(all(place));
  EXPECT_EQ(updates.back().json["lost"], 3000);
}

TEST_F(LiveFeedTest, ClayShapesOutliveForgottenTicks) {
  run_ticks(10);
  run_->store_vertex(1, {1, 0, 0.9});
  feed_->step();
  run_ticks(10);
  run_->store_vertex(3, {0.5, 0, 0.8});
  run_->store_split(0, {.vertex = 3, .ends = {0, 1}, .triangles = {0, 1}, .others = {2, 3}});
  feed_->step();
  LiveFeed::Place place;
  std::vector<LiveUpdate> shaped;
  for (const LiveUpdate& update : updates_of(all(place))) {
    if (!update.array<std::uint32_t>("shapes.vertices").empty()) shaped.push_back(update);
  }
  ASSERT_EQ(shaped.size(), 2U);
  EXPECT_EQ(shaped[0].array<std::uint32_t>("shapes.vertices"), (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(shaped[0].array<float>("shapes.places"), (std::vector<float>{1, 0, 0.9F}));
  EXPECT_EQ(shaped[1].array<std::uint32_t>("shapes.vertices"), (std::vector<std::uint32_t>{3}));
  EXPECT_EQ(shaped[1].array<std::uint32_t>("shapes.triangles"),
            (std::vector<std::uint32_t>{0, 1, 2, 3}));
  for (int update = 0; update < 61; ++update) {
    run_ticks(1000);
    feed_->step();
  }
  LiveFeed::Place late;
  const auto updates = updates_of(feed_->message(late));
  EXPECT_EQ(updates[0].array<std::uint32_t>("shapes.vertices"), (std::vector<std::uint32_t>{1, 3}));
  EXPECT_EQ(updates[0].array<float>("shapes.places"),
            (std::vector<float>{1, 0, 0.9F, 0.5F, 0, 0.8F}));
  EXPECT_EQ(updates[0].array<std::uint32_t>("shapes.corners").size(), 12U);
}

TEST_F(LiveFeedTest, DentOutlivesItsForgottenUpdate) {
  auto patch = std::make_unique<render::BodyPatch>();
  patch->object = 0;
  patch->point_count = 3;
  patch->triangle_count = 1;
  patch->triangles[0] = {0, 1, 2};
  patch->source[0] = 0;
  patch->points[2].p = {0, 0.5, -0.1};
  run_ticks(10);
  run_->store_patch(*patch);
  feed_->step();
  for (int update = 0; update < 61; ++update) {
    run_ticks(1000);
    feed_->step();
  }
  LiveFeed::Place late;
  const auto updates = updates_of(feed_->message(late));
  ASSERT_GE(updates.size(), 2U);
  EXPECT_EQ(updates[1].array<std::int16_t>("dents.object"), (std::vector<std::int16_t>{0}));
  EXPECT_EQ(updates[1].array<float>("dents.points"),
            (std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0.5F, -0.1F}));
}

TEST_F(LiveFeedTest, ReportsAFaultAndTheGateOnce) {
  LiveFeed::Place place;
  run_ticks(10);
  for (int i = 0; i < 40; ++i) {
    TickRecord tick = live_tick(next_++);
    tick.f_sent_W = {};
    tick.f_wanted_W = {0, 0, 2};
    run_->store_tick(tick);
    if (i % 10 == 0) feed_->step();
  }
  TickRecord fault = live_tick(next_++);
  fault.stage = driver::DeviceStage::kFault;
  fault.fault = driver::Fault::kOverSpeed;
  run_->store_tick(fault);
  feed_->step();
  std::map<std::uint64_t, nlohmann::json> marks;
  for (const LiveUpdate& update : updates_of(all(place))) {
    if (!update.json.contains("arms")) continue;
    for (const auto& mark : update.json["arms"][0]["marks"]) marks[mark[0]] = mark[1];
  }
  const auto of = [&](const char* kind) {
    return std::count_if(marks.begin(), marks.end(),
                         [&](const auto& mark) { return mark.second["kind"] == kind; });
  };
  EXPECT_EQ(of("gate"), 1);
  EXPECT_EQ(of("fault"), 1);
  for (const auto& [number, mark] : marks) {
    if (mark["kind"] != "gate") continue;
    EXPECT_NEAR(mark["begin"].get<double>(), 0.010, 1e-9);
    EXPECT_NEAR(mark["end"].get<double>(), 0.049, 1e-9);
    EXPECT_NE(mark["words"].get<std::string>().find("40 ticks"), std::string::npos);
  }
}

TEST_F(LiveFeedTest, SendsNothingWithoutChangesAndTheEndOnce) {
  run_ticks(5);
  feed_->step();
  const std::uint64_t before = feed_->end();
  feed_->step();
  feed_->step();
  EXPECT_EQ(feed_->end(), before);
  run_->set_state(session::RunState::kEnded);
  feed_->step();
  feed_->step();
  EXPECT_EQ(feed_->end(), before + 1);
  LiveFeed::Place place;
  EXPECT_EQ(updates_of(all(place)).back().json["state"], "ended");
}

}  // namespace
}  // namespace thimble::web
