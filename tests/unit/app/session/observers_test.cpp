// Each observer of a session separately, with ticks created by the test, without arm and scene.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "observers/black_box.h"
#include "observers/dent_record.h"
#include "observers/latest_tick.h"
#include "observers/pose_record.h"
#include "observers/trace.h"
#include "recording/recording_switch.h"
#include "share/knob_requests.h"
#include "share/live_knobs.h"
#include "share/run_sharing.h"
#include "share/shared_reader.h"
#include "support/heap_guard.h"
#include "support/scratch.h"
#include "support/scripted_run.h"
#include "thimble/render/object_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/session/recording.h"
#include "thimble/session/run_statistics.h"

namespace thimble {
namespace {

using driver::TickRecord;
using support::feed;
using support::scripted_run;

/// Object that moves by 1 mm and draws one more triangle with each call.
class Drawn final : public render::ObjectTouch {
 public:
  driver::ForceCommand update(const driver::DeviceState&) noexcept override { return {}; }
  bool inside(const Eigen::Vector3d&) const noexcept override { return false; }
  bool draw(render::BodyPatch& patch) noexcept override {
    patch.triangle_count = ++drawn_;
    return true;
  }
  render::BodyPose pose() const noexcept override {
    render::BodyPose pose;
    pose.p_WB = {1e-3 * ++asked_, 0, 0};
    return pose;
  }

 private:
  std::uint16_t drawn_ = 0;
  mutable int asked_ = 0;
};

render::SceneTouch drawn_scene(std::size_t objects = 1) {
  std::vector<std::unique_ptr<render::ObjectTouch>> list;
  for (std::size_t i = 0; i < objects; ++i) list.push_back(std::make_unique<Drawn>());
  return render::SceneTouch(std::move(list));
}

TEST(LatestTick, ShowsTheLastTickAndNoneBeforeTheFirst) {
  session::LatestTick latest;
  TickRecord tick;
  EXPECT_FALSE(latest.snapshot().load(tick));
  feed(latest, scripted_run(500, 100, 200));
  ASSERT_TRUE(latest.snapshot().load(tick));
  EXPECT_EQ(tick.tick, 499u);
  EXPECT_EQ(latest.snapshot().count(), 500u);
}

TEST(RunStatistics, SumUpAScriptedTouch) {
  session::RunStatistics statistics;
  feed(statistics, scripted_run(1000, 100, 300));
  EXPECT_EQ(statistics.ticks(), 1000u);
  EXPECT_EQ(statistics.contacts(), 1u);
  EXPECT_NEAR(statistics.contact_time(), 0.2, 1e-12);
  EXPECT_DOUBLE_EQ(statistics.depth_max(), 1e-3);
  EXPECT_DOUBLE_EQ(statistics.force_max(), 0.8);
}

TEST(BlackBox, HoldsTheTicksAroundAScriptedFault) {
  session::BlackBox box(1000);
  auto run = scripted_run(2000, 100, 1000);
  for (std::size_t i = 500; i < run.size(); ++i) run[i].fault = driver::Fault::kOverSpeed;
  feed(box, run);
  ASSERT_TRUE(box.full());
  const auto kept = box.release();
  ASSERT_EQ(kept.size(), 1001u) << "all before, the fault's tick, and half a second";
  EXPECT_EQ(kept.front().tick, 0u);
  EXPECT_EQ(kept.back().tick, 1000u);
  EXPECT_EQ(kept[500].fault, driver::Fault::kOverSpeed);
  EXPECT_TRUE(box.release().empty());
}

TEST(DentRecord, DrawsSixtyTimesASecondAndKeepsTheDeepest) {
  render::SceneTouch touch = drawn_scene();
  session::DentRecord dents(touch, 1'000'000);
  EXPECT_EQ(dents.drawn().drawings, 0u);
  feed(dents, scripted_run(1000, 100, 300));
  EXPECT_EQ(dents.drawn().drawings, 63u) << "every sixteenth tick, from tick 0";
  EXPECT_EQ(dents.drawn().patch.triangle_count, 63);
  // The touch is deepest in tick 200; the deepest drawn dent is the thirteenth, of tick 192.
  EXPECT_EQ(dents.deepest().triangle_count, 13);
}

TEST(DentRecord, KeepsNothingOfARunWithoutATouch) {
  render::SceneTouch touch = drawn_scene();
  session::DentRecord dents(touch, 1'000'000);
  feed(dents, scripted_run(100, 0, 0));
  EXPECT_EQ(dents.deepest().triangle_count, 0);
}

TEST(PoseRecord, ShowsTheObjectsThatMoveAfterEachTick) {
  const render::SceneTouch touch = drawn_scene(3);
  const std::vector<std::size_t> moving{0, 2};
  session::PoseRecord poses(touch, moving);
  feed(poses, scripted_run(7, 0, 0));
  EXPECT_EQ(poses.now().tick, 6u);
  ASSERT_EQ(poses.now().count, 2u);
  EXPECT_EQ(poses.now().object[1], 2);
  EXPECT_DOUBLE_EQ(poses.now().pose[1].p_WB[0], 7e-3);
}

session::RecordingInfo small_info() {
  session::RecordingInfo info;
  info.scene = "scripted";
  info.rate = 1000;
  return info;
}

TEST(RecordingSwitch, RecordsOnlyWhileSwitchedOn) {
  const auto file = support::scratch_folder() / "switch.h5";
  const auto run = scripted_run(20'000, 100, 300);
  for (const bool by_thread : {false, true}) {
    SCOPED_TRACE(by_thread);
    session::RecordingSwitch recording;
    std::size_t i = 0;
    for (; i < 50; ++i) recording.take(run[i]);
    EXPECT_FALSE(recording.on());
    ASSERT_TRUE(recording.begin(file, small_info(), run.size(), by_thread, true));
    // More ticks than the ring holds: without a thread the servo must empty it.
    const std::size_t until = by_thread ? 5'000 : 19'000;
    for (; i < until; ++i) recording.take(run[i]);
    ASSERT_TRUE(recording.stop());
    for (; i < run.size(); ++i) recording.take(run[i]);
    const auto read = session::read_recording(file);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->ticks.size(), until - 50);
    EXPECT_EQ(read->ticks.front().tick, 50u);
    EXPECT_EQ(read->ticks.back().tick, until - 1);
  }
}

/// Run shared in this process, with an object that dents and one that moves.
struct Shared {
  Shared() {
    session::SharedScene scene;
    scene.name = "scripted";
    scene.period_ns = 1'000'000;
    scene.force_max = 6;
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    scene.triangles = {{0, 1, 2}, {3, 4, 5}};
    scene.objects.push_back(
        {.name = "soft", .dents = true, .vertex_count = 3, .triangle_count = 1});
    scene.objects.push_back({.name = "free",
                             .colour = 1,
                             .moves = true,
                             .first_vertex = 3,
                             .vertex_count = 3,
                             .first_triangle = 1,
                             .triangle_count = 1});
    run = session::SharedRun::create("", scene, 100).value();
    reader = session::SharedReader::over(run->memory().again().value()).value();
  }
  std::unique_ptr<session::SharedRun> run;
  std::unique_ptr<session::SharedReader> reader;
};

TEST(RunSharing, StoresEachTickAndWhatMovedInIt) {
  const Shared shared;
  session::DrawnDent dent;
  session::ScenePoses poses;
  poses.count = 1;
  poses.object[0] = 1;
  session::RunSharing sharing(*shared.run, {.dent = &dent, .poses = &poses, .shaped = {}});
  for (const TickRecord& tick : scripted_run(90, 10, 60)) {
    poses.tick = tick.tick;
    poses.pose[0].p_WB = {static_cast<double>(tick.tick), 0, 0};
    if (tick.tick % 16 == 0) ++dent.drawings;
    sharing.take(tick);
  }
  TickRecord newest;
  ASSERT_TRUE(shared.reader->newest(newest));
  EXPECT_EQ(newest.tick, 89u);
  std::uint64_t serial = 0;
  std::vector<TickRecord> ticks;
  EXPECT_EQ(shared.reader->ticks_since(serial, ticks), 0u);
  EXPECT_EQ(ticks.size(), 90u);
  EXPECT_EQ(shared.reader->patch_count(), 6u) << "once for each drawing";
  session::ScenePoses seen;
  ASSERT_TRUE(shared.reader->poses(seen));
  EXPECT_EQ(seen.tick, 89u);
  EXPECT_EQ(seen.pose[0].p_WB[0], 89);
  EXPECT_EQ(shared.reader->rejected(), 0u);
}

TEST(RunSharing, StoresNothingOfASceneInWhichNothingMoves) {
  const Shared shared;
  session::RunSharing sharing(*shared.run, {});
  feed(sharing, scripted_run(20, 5, 10));
  session::ScenePoses poses;
  EXPECT_FALSE(shared.reader->poses(poses));
  EXPECT_EQ(shared.reader->patch_count(), 0u);
  EXPECT_EQ(shared.reader->counters().ticks, 20u);
}

TEST(Observers, AllocateNothingPerTick) {
  render::SceneTouch touch = drawn_scene();
  const std::vector<std::size_t> moving{0};
  const Shared shared;
  session::LatestTick latest;
  session::RunStatistics statistics;
  session::Trace trace(500, 100);
  session::BlackBox box(1000);
  session::DentRecord dents(touch, 1'000'000);
  session::PoseRecord poses(touch, moving);
  session::RecordingSwitch recording;
  ASSERT_TRUE(recording.begin(support::scratch_folder() / "quiet.h5", small_info(), 2000, true));
  session::RunSharing sharing(*shared.run,
                              {.dent = &dents.drawn(), .poses = &poses.now(), .shaped = {}});
  auto run = scripted_run(1000, 100, 900);
  for (std::size_t i = 950; i < run.size(); ++i) run[i].fault = driver::Fault::kOverSpeed;
  // Counted on this thread; the recorder's thread may allocate.
  EXPECT_EQ(support::heap_calls_of([&] {
              for (session::TickObserver* one : std::initializer_list<session::TickObserver*>{
                       &latest, &statistics, &trace, &box, &dents, &poses, &recording, &sharing}) {
                feed(*one, run);
              }
            }),
            0);
  EXPECT_EQ(statistics.ticks(), 1000u);
  EXPECT_TRUE(recording.stop());
}

/// Requests a value of the first knob, and keeps the values that are in force.
class Requests final : public session::KnobRequests {
 public:
  std::optional<double> knob_wanted(std::size_t knob) const noexcept override {
    return knob == 0 ? std::optional(wanted) : std::nullopt;
  }
  void store_knob(std::size_t, double now) noexcept override { stored.push_back(now); }
  double wanted = 0;
  std::vector<double> stored;
};

TEST(LiveKnobs, StoreEachValueOnTheWayToTheTarget) {
  const auto scene = scene::load_scene(std::string(THIMBLE_SOURCE_DIR) + "/app/scenes/rubber.yaml");
  ASSERT_TRUE(scene) << scene.error().message;
  const auto objects = scene::SceneObjects::build(*scene);
  ASSERT_TRUE(objects) << objects.error().message;
  session::LiveKnobs knobs(*scene, (*objects)->touch());
  const auto described = knobs.described();
  ASSERT_FALSE(described.empty());
  Requests requests;
  requests.wanted = described[0].initial / 2;
  for (int tick = 0; tick < 3; ++tick) {
    ASSERT_TRUE(knobs.step(requests, {}, 1e-3));
    ASSERT_EQ(requests.stored.size(), static_cast<std::size_t>(tick) + 1);
    EXPECT_EQ(requests.stored.back(), knobs.value(0));
  }
}

}  // namespace
}  // namespace thimble
