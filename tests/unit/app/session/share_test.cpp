#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "hold_key.h"
#include "mesh/contact_mesh.h"
#include "share/arm_lines.h"
#include "share/run_attachment.h"
#include "share/shared_reader.h"
#include "share/shared_run.h"
#include "share/turn_knob.h"
#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/seed.h"

namespace thimble::session {
namespace {

using driver::TickRecord;

/// Makes a scene with a triangle, a two-sided shaped one whose edges may be split, and a knob.
session::SharedScene small_scene() {
  session::SharedScene scene;
  scene.name = "small";
  scene.file = "scenes/small.yaml";
  scene.period_ns = 1'000'000;
  scene.force_max = 6;
  scene.arms.front().name = "vintage";
  scene.arms.front().device = "sim";
  scene.arms.front().geometry =
      driver::SerialArm{.height = 0.1, .length_b = 0.13, .length_c = 0.16};
  scene.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  scene.triangles = {{0, 1, 2}, {3, 4, 5}, {4, 3, 5}};
  scene.objects.push_back({.name = "stiff", .dents = true, .vertex_count = 3, .triangle_count = 1});
  scene.objects.push_back({.name = "clay",
                           .colour = 1,
                           .shaped = true,
                           .first_vertex = 3,
                           .vertex_count = 3,
                           .first_triangle = 1,
                           .triangle_count = 2,
                           .max_splits = 2});
  scene.objects[0].texture = "sandpaper";
  scene.objects[0].friction = "bristle, dahl";
  scene.objects[0].map = {
      .quantity = "stiffness", .unit = "N/m", .min = 200, .max = 800, .parts = 2};
  scene.map_values = {0, 0.25F, 0.5F, 0.75F, 1, 0.125F};
  scene.field = {{{0, 0, 0.1}, {0, 0, -1}}, {{0, 0, 0.2}, {0, 0.5, 0}}};
  scene.knobs.push_back({"stiff: stiffness", "N/m", 0, 1000, 800});
  return scene;
}

/// Returns a name that no other test uses meanwhile.
std::string name_for(const char* test) {
  return std::string(test) + "-" + std::to_string(getpid());
}

/// Returns an object's mesh as described.
render::TriangleMesh mesh_of(const session::SharedScene& scene, std::size_t number) {
  const auto& object = scene.objects[number];
  render::TriangleMesh mesh;
  for (std::size_t i = 0; i < object.vertex_count; ++i) {
    mesh.vertices.push_back(scene.vertices[object.first_vertex + i]);
  }
  for (std::size_t i = 0; i < object.triangle_count; ++i) {
    auto& corners = mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<std::int32_t>(scene.triangles[object.first_triangle + i][k] -
                                             object.first_vertex);
    }
  }
  return mesh;
}

/// Makes a tick in which all values follow from one number, so that a torn read is detected.
TickRecord tick_number(std::uint64_t number) {
  TickRecord tick;
  tick.tick = number;
  tick.time_ns = tick.due_ns = static_cast<std::int64_t>(number) * 1'000'000;
  for (auto* vector :
       {&tick.q, &tick.p_WT, &tick.v_WT, &tick.p_WP, &tick.n_W, &tick.f_wanted_W, &tick.f_sent_W}) {
    vector->fill(static_cast<double>(number));
  }
  tick.depth = static_cast<double>(number);
  return tick;
}

bool whole(const TickRecord& tick) {
  const auto number = static_cast<double>(tick.tick);
  for (const auto* vector :
       {&tick.q, &tick.p_WT, &tick.v_WT, &tick.p_WP, &tick.n_W, &tick.f_wanted_W, &tick.f_sent_W}) {
    for (const double x : *vector) {
      if (x != number) return false;
    }
  }
  return tick.depth == number;
}

struct Pair {
  std::unique_ptr<session::SharedRun> run;
  std::unique_ptr<session::SharedReader> reader;
};

/// Connects a run and a reader through memory without a name.
Pair joined(const session::SharedScene& scene, std::size_t ring_ticks = 100) {
  Pair pair;
  pair.run = session::SharedRun::create("", scene, ring_ticks).value();
  pair.reader = session::SharedReader::over(pair.run->memory().again().value()).value();
  return pair;
}

TEST(Share, ShowsTheSceneAsItWasDescribed) {
  const session::SharedScene scene = small_scene();
  const Pair pair = joined(scene);
  const session::SharedScene& seen = pair.reader->scene();
  EXPECT_EQ(seen.name, scene.name);
  EXPECT_EQ(seen.file, scene.file);
  EXPECT_EQ(seen.period_ns, scene.period_ns);
  EXPECT_EQ(seen.force_max, scene.force_max);
  EXPECT_EQ(seen.pid, getpid());
  EXPECT_EQ(seen.arms.front().name, "vintage");
  ASSERT_TRUE(seen.arms.front().geometry.has_value());
  const auto& built = std::get<driver::SerialArm>(*seen.arms.front().geometry);
  EXPECT_EQ(built.height, 0.1);
  EXPECT_EQ(built.length_b, 0.13);
  EXPECT_EQ(built.length_c, 0.16);
  EXPECT_EQ(seen.vertices, scene.vertices);
  EXPECT_EQ(seen.triangles, scene.triangles);
  ASSERT_EQ(seen.objects.size(), 2U);
  EXPECT_EQ(seen.objects[1].name, "clay");
  EXPECT_TRUE(seen.objects[0].dents);
  EXPECT_TRUE(seen.objects[1].shaped);
  EXPECT_EQ(seen.objects[1].first_vertex, 3U);
  EXPECT_EQ(seen.objects[0].texture, "sandpaper");
  EXPECT_EQ(seen.objects[0].friction, "bristle, dahl");
  EXPECT_EQ(seen.objects[1].friction, "");
  ASSERT_EQ(seen.field.size(), 2U);
  EXPECT_EQ(seen.field[1].p_W, scene.field[1].p_W);
  EXPECT_EQ(seen.field[1].f_W, scene.field[1].f_W);
  ASSERT_EQ(seen.knobs.size(), 1U);
  EXPECT_EQ(seen.knobs[0].name, "stiff: stiffness");
  EXPECT_EQ(seen.knobs[0].unit, "N/m");
  EXPECT_EQ(pair.reader->state(), session::RunState::kLoading);
}

TEST(Share, ShowsTheMapOfAnObject) {
  const session::SharedScene scene = small_scene();
  const Pair pair = joined(scene);
  const session::SharedScene& seen = pair.reader->scene();
  EXPECT_EQ(seen.objects[0].map.quantity, "stiffness");
  EXPECT_EQ(seen.objects[0].map.unit, "N/m");
  EXPECT_EQ(seen.objects[0].map.min, 200);
  EXPECT_EQ(seen.objects[0].map.max, 800);
  EXPECT_EQ(seen.objects[0].map.parts, 2U);
  EXPECT_EQ(seen.map_values, scene.map_values);
  EXPECT_EQ(seen.objects[1].map.parts, 0U) << "it has no map";
}

TEST(Share, RejectsAMapThatItsValuesDoNotFill) {
  const auto refused = [](void (*spoil)(session::SharedScene & scene)) {
    session::SharedScene scene = small_scene();
    spoil(scene);
    const auto run = session::SharedRun::create("", scene, 10).value();
    return !session::SharedReader::over(run->memory().bytes());
  };
  EXPECT_FALSE(refused([](session::SharedScene&) {}));
  EXPECT_TRUE(refused([](session::SharedScene& scene) { scene.map_values.pop_back(); }));
  EXPECT_TRUE(refused([](session::SharedScene& scene) { scene.objects[0].map.parts = 3; }));
  EXPECT_TRUE(refused([](session::SharedScene& scene) { scene.objects[0].map.parts = ~0U; }));
  EXPECT_TRUE(refused([](session::SharedScene& scene) { scene.objects[0].map.first_value = 1; }));
  EXPECT_TRUE(refused([](session::SharedScene& scene) { scene.objects[0].map.min = 801; }));
  EXPECT_TRUE(refused([](session::SharedScene& scene) { scene.map_values[2] = 1.5F; }));
  EXPECT_TRUE(refused([](session::SharedScene& scene) {
    scene.map_values[2] = std::numeric_limits<float>::quiet_NaN();
  }));
}

/// Returns the small scene, whose first object collides as its own triangle and the second as the
/// first.
session::SharedScene colliding_scene() {
  session::SharedScene scene = small_scene();
  for (session::SharedScene::Object& object : scene.objects) {
    object.collider_vertex_count = 3;
    object.collider_triangle_count = 1;
  }
  return scene;
}

TEST(Share, ShowsTheShapeThatCollides) {
  const Pair pair = joined(colliding_scene());
  const auto& object = pair.reader->scene().objects[1];
  EXPECT_EQ(object.collider_first_vertex, 0U);
  EXPECT_EQ(object.collider_vertex_count, 3U);
  EXPECT_EQ(object.collider_first_triangle, 0U);
  EXPECT_EQ(object.collider_triangle_count, 1U);
}

TEST(Share, RejectsAShapeOutsideItsTables) {
  const auto refused = [](void (*spoil)(session::SharedScene::Object & object)) {
    session::SharedScene scene = colliding_scene();
    spoil(scene.objects[1]);
    const auto run = session::SharedRun::create("", scene, 10).value();
    return !session::SharedReader::over(run->memory().bytes());
  };
  using Object = session::SharedScene::Object;
  EXPECT_FALSE(refused([](Object&) {}));
  EXPECT_TRUE(refused([](Object& object) { object.collider_triangle_count = 4; }));
  EXPECT_TRUE(refused([](Object& object) { object.collider_vertex_count = 7; }));
  EXPECT_TRUE(refused([](Object& object) { object.collider_first_triangle = SIZE_MAX; }));
  EXPECT_TRUE(refused([](Object& object) { object.collider_vertex_count = 2; }))
      << "a vertex of it";
  EXPECT_TRUE(refused([](Object& object) { object.collider_first_vertex = 1; }));
}

TEST(Share, ShowsTheNewestTickAndThoseBefore) {
  const Pair pair = joined(small_scene(), 10);
  TickRecord seen;
  EXPECT_FALSE(pair.reader->newest(seen)) << "nothing was stored yet";
  std::uint64_t serial = 0;
  std::vector<TickRecord> ticks;
  for (std::uint64_t i = 0; i < 4; ++i) pair.run->store_tick(tick_number(i));
  ASSERT_TRUE(pair.reader->newest(seen));
  EXPECT_EQ(seen.tick, 3U);
  EXPECT_EQ(pair.reader->ticks_since(serial, ticks), 0U);
  ASSERT_EQ(ticks.size(), 4U);
  for (std::uint64_t i = 0; i < 4; ++i) EXPECT_EQ(ticks[i].tick, i);

  // A reader that sleeps while the ring wraps around gets the number of missed ticks.
  ticks.clear();
  for (std::uint64_t i = 4; i < 29; ++i) pair.run->store_tick(tick_number(i));
  EXPECT_EQ(pair.reader->ticks_since(serial, ticks), 15U);
  ASSERT_EQ(ticks.size(), 10U);
  EXPECT_EQ(ticks.front().tick, 19U);
  EXPECT_EQ(ticks.back().tick, 28U);
  EXPECT_EQ(pair.reader->ticks_since(serial, ticks), 0U);
  EXPECT_EQ(ticks.size(), 10U) << "nothing new";
}

TEST(Share, CountsPeriodsThatTheLoopMissed) {
  const Pair pair = joined(small_scene());
  pair.run->store_tick(tick_number(0));
  pair.run->store_tick(tick_number(1));
  pair.run->store_tick(tick_number(5));
  EXPECT_EQ(pair.reader->counters().missed, 3U);
  EXPECT_EQ(pair.reader->counters().ticks, 3U);
}

TEST(Share, CountsPausedTicksSeparately) {
  for (const bool wall : {true, false}) {
    session::SharedScene scene = small_scene();
    scene.wall_clock = wall;
    const Pair pair = joined(scene);
    pair.run->set_state(session::RunState::kRunning);
    pair.run->store_tick(tick_number(0));
    pair.run->set_state(session::RunState::kPaused);
    pair.run->store_tick(tick_number(1));
    pair.run->store_tick(tick_number(5));
    pair.run->set_state(session::RunState::kRunning);
    pair.run->store_tick(tick_number(6));
    const auto counters = pair.reader->counters();
    EXPECT_EQ(counters.ticks, 4U);
    // Simulated time stops in a pause, so ticks in a pause are single steps.
    EXPECT_EQ(counters.paused, wall ? 2U : 0U);
    EXPECT_EQ(counters.missed, wall ? 0U : 3U);
  }
}

TEST(Share, RequestsASpeedAndIgnoresInvalidOnes) {
  session::SharedScene scene = small_scene();
  const auto refused = [](const driver::Result<void>& asked) {
    return asked ? std::string() : asked.error().message;
  };
  {
    const Pair pair = joined(scene);
    EXPECT_NE(refused(pair.reader->ask_speed(2)).find("--clock paced"), std::string::npos);
    EXPECT_NE(refused(pair.reader->ask_restart()).find("cannot be restarted"), std::string::npos);
  }
  scene.paced = scene.restarts = true;
  const Pair pair = joined(scene);
  EXPECT_FALSE(pair.run->speed_wanted()) << "there is no request";
  EXPECT_EQ(pair.reader->speed_asked(), 1);
  ASSERT_TRUE(pair.reader->ask_speed(0.25));
  EXPECT_EQ(pair.run->speed_wanted(), 0.25);
  EXPECT_FALSE(pair.reader->ask_speed(std::numeric_limits<double>::quiet_NaN()));
  pair.run->set_pace(4, true);
  EXPECT_EQ(pair.reader->speed_asked(), 0.25) << "a viewer was quicker than the run";
  EXPECT_TRUE(pair.reader->loop_asked());
  auto& live = *reinterpret_cast<session::SharedLive*>(pair.run->memory().bytes().data() +
                                                       session::kSharedLiveOffset);
  live.requests.speed.store(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(pair.run->speed_wanted());
  EXPECT_EQ(pair.reader->speed_asked(), 1);
  EXPECT_FALSE(pair.run->restart_request_after(0));
  ASSERT_TRUE(pair.reader->ask_restart("/a/b.yaml"));
  const auto order = pair.run->restart_request_after(0);
  ASSERT_TRUE(order);
  EXPECT_EQ(order->scene, "/a/b.yaml");
  EXPECT_FALSE(pair.run->restart_request_after(order->number));
  ASSERT_TRUE(pair.reader->ask_restart());
  EXPECT_EQ(pair.run->restart_request_after(order->number)->scene, "");
  pair.run->set_notice("line 3: \x1b wrong\nmore");
  EXPECT_EQ(pair.reader->notice(), "line 3: ? wrong\nmore");
}

TEST(Share, ReadsAreNeverTorn) {
  const Pair pair = joined(small_scene(), 64);
  std::atomic<bool> stop{false};
  std::atomic<std::uint64_t> reads{0}, torn{0};
  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      // Both sides use the same mapping, so that the thread sanitizer can check them.
      const auto reader = session::SharedReader::over(pair.run->memory().bytes()).value();
      std::uint64_t serial = 0;
      std::vector<TickRecord> ticks;
      render::BodyPatch patch{};
      session::ScenePoses poses;
      while (!stop.load()) {
        ticks.clear();
        TickRecord tick;
        if (reader->newest(tick)) ticks.push_back(tick);
        reader->ticks_since(serial, ticks);
        for (const TickRecord& one : ticks) torn += whole(one) ? 0 : 1;
        reads += ticks.size();
        if (reader->patch(patch)) {
          for (std::size_t t = 0; t < patch.point_count; ++t) {
            torn += patch.points[t].p[0] == patch.points[0].p[0] ? 0 : 1;
          }
          ++reads;
        }
        if (reader->poses(poses)) {
          torn += poses.pose[0].p_WB[0] == static_cast<double>(poses.tick) ? 0 : 1;
          ++reads;
        }
      }
    });
  }
  const std::uint64_t rounds = support::long_form() ? 3'000'000 : 30'000;
  render::BodyPatch patch{};
  patch.object = 0;
  patch.point_count = 300;
  session::ScenePoses poses;
  poses.count = 1;
  for (std::uint64_t i = 0; i < rounds || reads.load() < 1000; ++i) {
    pair.run->store_tick(tick_number(i));
    poses.tick = i;
    poses.pose[0].p_WB[0] = static_cast<double>(i);
    pair.run->store_poses(poses);
    if (i % 16 != 0) continue;
    for (std::size_t t = 0; t < patch.point_count; ++t) {
      patch.points[t].p[0] = static_cast<double>(i);
    }
    pair.run->store_patch(patch);
  }
  stop.store(true);
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn.load(), 0U);
  EXPECT_GE(reads.load(), 1000U) << "nothing was put to the test";
}

TEST(Share, StoresWithoutAllocation) {
  const Pair pair = joined(small_scene());
  render::BodyPatch patch{};
  session::SharedHand hand;
  const int calls = support::heap_calls_of([&] {
    for (std::uint64_t i = 0; i < 300; ++i) {
      pair.run->store_tick(tick_number(i));
      pair.run->store_poses({});
      pair.run->store_patch(patch);
      pair.run->store_vertex(i, {0, 0, 0});
      pair.run->store_split(i, {});
      pair.run->store_knob(0, pair.run->knob_wanted(0).value_or(0));
      static_cast<void>(pair.run->hand(hand));
    }
  });
  EXPECT_EQ(calls, 0);
}

TEST(Share, ShowsPermanentlyMovedVertices) {
  const Pair pair = joined(small_scene());
  const render::TriangleMesh first = mesh_of(pair.reader->scene(), 1);
  render::TriangleMesh mesh = first;
  pair.reader->shape(1, mesh);
  EXPECT_EQ(mesh.vertices, first.vertices) << "nothing has moved";
  pair.run->store_vertex(1, {7, 8, 9});
  pair.run->store_vertex(5, {7, 8, 9});  // there is none
  EXPECT_EQ(pair.reader->shape_moves(), 1U);
  pair.reader->shape(1, mesh);
  EXPECT_EQ(mesh.vertices[0], first.vertices[0]);
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(mesh.triangles, first.triangles);
}

TEST(Share, ShowsPermanentlySplitTriangles) {
  const Pair pair = joined(small_scene());
  render::TriangleMesh mesh = mesh_of(pair.reader->scene(), 1);
  const render::TriangleMesh first = mesh;
  using Triangles = decltype(mesh.triangles);
  pair.run->store_vertex(3, {1, 2, 3});
  pair.reader->shape(1, mesh);
  EXPECT_EQ(mesh.vertices, first.vertices) << "a vertex is there once its edge is split";
  pair.run->store_split(0, {.vertex = 3, .ends = {0, 1}, .triangles = {0, 1}, .others = {2, 3}});
  EXPECT_EQ(pair.reader->shape_moves(), 2U);
  pair.reader->shape(1, mesh);
  const Triangles once{{0, 3, 2}, {3, 0, 2}, {3, 1, 2}, {1, 3, 2}};
  EXPECT_EQ(mesh.triangles, once);
  ASSERT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.vertices[3], Eigen::Vector3d(1, 2, 3));
  // From the previous shape, and again from the initial one.
  pair.run->store_vertex(4, {4, 5, 6});
  pair.run->store_split(1, {.vertex = 4, .ends = {2, 3}, .triangles = {0, 2}, .others = {4, 5}});
  pair.run->store_split(2, {});  // there is none
  render::TriangleMesh fresh = first;
  pair.reader->shape(1, mesh);
  pair.reader->shape(1, fresh);
  const Triangles twice{{0, 4, 2}, {3, 0, 2}, {4, 1, 2}, {1, 3, 2}, {0, 3, 4}, {3, 1, 4}};
  EXPECT_EQ(mesh.triangles, twice);
  EXPECT_EQ(fresh.triangles, twice);
  EXPECT_EQ(fresh.vertices, mesh.vertices);
  EXPECT_EQ(mesh.vertices[4], Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(pair.reader->rejected(), 0U);
}

TEST(Share, RejectsASplitOfAMissingEdge) {
  for (const render::EdgeSplit& wrong : {render::EdgeSplit{.ends = {0, 9}, .triangles = {0, 1}},
                                         render::EdgeSplit{.ends = {-1, 0}, .triangles = {0, 1}},
                                         render::EdgeSplit{.ends = {1, 1}, .triangles = {0, 1}},
                                         render::EdgeSplit{.ends = {0, 1}, .triangles = {0, 0}},
                                         render::EdgeSplit{.ends = {0, 1}, .triangles = {0, 2}},
                                         render::EdgeSplit{.ends = {0, 1}, .triangles = {-1, 0}}}) {
    const Pair pair = joined(small_scene());
    render::TriangleMesh mesh = mesh_of(pair.reader->scene(), 1);
    const render::TriangleMesh first = mesh;
    pair.run->store_split(0, wrong);
    pair.reader->shape(1, mesh);
    EXPECT_EQ(pair.reader->rejected(), 1U);
    EXPECT_EQ(mesh.vertices, first.vertices);
    EXPECT_EQ(mesh.triangles, first.triangles);
  }
}

TEST(Share, ChangesKnobsOnlyWithinTheirBounds) {
  const Pair pair = joined(small_scene());
  EXPECT_EQ(pair.reader->knob(0), 800);
  EXPECT_EQ(pair.run->knob_wanted(0), 800);
  pair.reader->turn_knob(0, 300);
  EXPECT_EQ(pair.run->knob_wanted(0), 300);
  pair.reader->turn_knob(0, 5000);
  EXPECT_EQ(pair.run->knob_wanted(0), 1000);
  pair.reader->turn_knob(0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(pair.run->knob_wanted(0), 1000);
  pair.run->store_knob(0, 400);
  EXPECT_EQ(pair.reader->knob(0), 400);
}

TEST(Share, PassesRequestsOfViewers) {
  const Pair pair = joined(small_scene());
  EXPECT_FALSE(pair.run->pause_asked());
  pair.reader->ask_pause(true);
  EXPECT_TRUE(pair.run->pause_asked());
  EXPECT_FALSE(pair.run->stop_asked());
  pair.reader->ask_stop();
  EXPECT_TRUE(pair.run->stop_asked());

  EXPECT_FALSE(pair.run->record_request_after(0));
  ASSERT_TRUE(pair.reader->ask_record("touch.h5"));
  auto order = pair.run->record_request_after(0);
  ASSERT_TRUE(order);
  EXPECT_TRUE(order->record);
  EXPECT_EQ(order->path, "touch.h5");
  ASSERT_TRUE(pair.reader->ask_record_stop());
  order = pair.run->record_request_after(order->number);
  ASSERT_TRUE(order);
  EXPECT_FALSE(order->record);
  EXPECT_FALSE(pair.run->record_request_after(order->number));

  session::SharedHand hand;
  EXPECT_FALSE(pair.run->hand(hand)) << "no viewer has moved it";
  ASSERT_TRUE(pair.reader->lead_hand({0.01, 0.02, 0.03}, true));
  ASSERT_TRUE(pair.run->hand(hand));
  EXPECT_EQ(hand.p_WH[1], 0.02);
  EXPECT_EQ(hand.active, 1U);
  EXPECT_FALSE(pair.reader->lead_hand({std::numeric_limits<double>::infinity(), 0, 0}, true));
}

/// Runs `work` on a run's memory in a child process, which then dies by SIGKILL.
template <class Work>
void in_a_viewer_that_is_killed(Work work) {
  const pid_t viewer = fork();
  if (viewer == 0) {
    work();
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(viewer, &status, 0), viewer);
  ASSERT_TRUE(WIFSIGNALED(status));
}

/// Runs `work` with a separate viewer in a child process, which then dies by SIGKILL.
template <class Work>
void viewer_that_is_killed(const Pair& pair, Work work) {
  in_a_viewer_that_is_killed([&] {
    const auto own = session::SharedReader::over(pair.run->memory().again().value()).value();
    work(*own);
    raise(SIGKILL);  // including its place
  });
}

/// Returns the requests of viewers in the memory of a run.
session::SharedRequests& requests_of(const Pair& pair) {
  return reinterpret_cast<session::SharedLive*>(pair.run->memory().bytes().data() +
                                                session::kSharedLiveOffset)
      ->requests;
}

/// Leaves a snapshot as a writer that is killed while writing: its first word is odd.
template <class T>
void tear(driver::Snapshot<T>& snapshot) {
  auto& sequence = *reinterpret_cast<std::atomic<std::uint64_t>*>(&snapshot);
  sequence.store(sequence.load() | 1);
}

template <class T>
bool is_torn(const driver::Snapshot<T>& snapshot) {
  return reinterpret_cast<const std::atomic<std::uint64_t>*>(&snapshot)->load() % 2 != 0;
}

TEST(Share, ReportsThatAKeyMustBeHeld) {
  session::SharedScene scene = small_scene();
  EXPECT_FALSE(joined(scene).reader->scene().hold_by_key);
  scene.hold_by_key = true;
  EXPECT_TRUE(joined(scene).reader->scene().hold_by_key);
}

TEST(Share, CountsPicturesInWhichAKeyIsHeld) {
  const Pair pair = joined(small_scene());
  EXPECT_EQ(pair.run->key_held(), 0U);
  pair.reader->hold_key();
  pair.reader->hold_key();
  EXPECT_EQ(pair.run->key_held(), 2U);
}

TEST(Share, KeyOfAViewerThatDiesIsReleased) {
  const Pair pair = joined(small_scene());
  viewer_that_is_killed(pair, [](auto& viewer) { viewer.hold_key(); });
  session::ViewerKey key(0);
  key.update(pair.run->key_held(), 0);
  key.update(pair.run->key_held(), 1'000'000'000);
  EXPECT_LE(key.until_ns(), session::HeldKey::kLasts_ns);
}

TEST(Share, HandOfDeadViewerIsReleased) {
  const Pair pair = joined(small_scene());
  viewer_that_is_killed(pair, [](auto& viewer) { viewer.lead_hand({0, 0, 0}, true); });
  session::SharedHand hand;
  ASSERT_TRUE(pair.run->hand(hand));
  EXPECT_EQ(hand.active, 1U);
  pair.run->watch_viewers();
  ASSERT_TRUE(pair.run->hand(hand));
  EXPECT_EQ(hand.active, 0U);
}

TEST(Share, HandStaysWithLiveViewer) {
  const Pair pair = joined(small_scene());
  ASSERT_TRUE(pair.reader->lead_hand({0, 0, 0}, true));
  pair.run->watch_viewers();
  session::SharedHand hand;
  ASSERT_TRUE(pair.run->hand(hand));
  EXPECT_EQ(hand.active, 1U);
}

TEST(Share, HalfWrittenHandIsReleasedWhereItWas) {
  const Pair pair = joined(small_scene());
  ASSERT_TRUE(pair.reader->lead_hand({1, 2, 3}, true));
  pair.run->watch_viewers();
  tear(requests_of(pair).hand);
  session::SharedHand hand;
  ASSERT_FALSE(pair.run->hand(hand)) << "a partly written target must be ignored";
  pair.run->watch_viewers();
  ASSERT_TRUE(pair.run->hand(hand));
  EXPECT_EQ(hand.active, 0U);
  EXPECT_EQ(hand.p_WH[2], 3);
}

TEST(Share, HandThatIsBeingWrittenIsLeftAlone) {
  const Pair pair = joined(small_scene());
  ASSERT_TRUE(pair.reader->lead_hand({1, 2, 3}, true));
  const auto writer = pair.run->memory().again().value();
  ASSERT_TRUE(writer->lock(session::kTurnByte));
  tear(requests_of(pair).hand);
  pair.run->watch_viewers();
  EXPECT_TRUE(is_torn(requests_of(pair).hand));
}

TEST(Share, AcceptsRequestsAfterAViewerWasKilled) {
  const Pair pair = joined(small_scene());
  in_a_viewer_that_is_killed([&] {
    const auto own = pair.run->memory().again().value();
    if (!own->lock(session::kTurnByte)) return;
    tear(requests_of(pair).hand);
    raise(SIGKILL);
  });
  ASSERT_TRUE(is_torn(requests_of(pair).hand));
  ASSERT_TRUE(pair.reader->lead_hand({2, 2, 2}, true));
  session::SharedHand hand;
  ASSERT_TRUE(pair.run->hand(hand));
  EXPECT_EQ(hand.p_WH[0], 2);
}

TEST(Share, RestartWorksAfterHalfWrittenOne) {
  session::SharedScene scene = small_scene();
  scene.paced = scene.restarts = true;
  const Pair pair = joined(scene);
  ASSERT_TRUE(pair.reader->ask_restart("/first.yaml"));
  ASSERT_TRUE(pair.run->restart_request_after(0));
  tear(requests_of(pair).restart);
  ASSERT_TRUE(pair.reader->ask_restart("/second.yaml"));
  const auto order = pair.run->restart_request_after(1);
  ASSERT_TRUE(order) << "its number did not grow";
  EXPECT_EQ(order->scene, "/second.yaml");
}

TEST(Share, HalfWrittenRecordingPathIsNoPath) {
  const Pair pair = joined(small_scene());
  ASSERT_TRUE(pair.reader->ask_record("touch.h5"));
  tear(requests_of(pair).record_path);
  EXPECT_FALSE(pair.run->record_request_after(0));
}

TEST(Share, PauseOfDeadViewerEnds) {
  const Pair pair = joined(small_scene());
  viewer_that_is_killed(pair, [](auto& viewer) { viewer.ask_pause(true); });
  ASSERT_TRUE(pair.run->pause_asked());
  EXPECT_TRUE(pair.run->watch_viewers());
  EXPECT_FALSE(pair.run->pause_asked());
}

TEST(Share, PauseOfLiveViewerStays) {
  const Pair pair = joined(small_scene());
  pair.reader->ask_pause(true);
  EXPECT_FALSE(pair.run->watch_viewers());
  EXPECT_TRUE(pair.run->pause_asked());
}

TEST(Share, PauseOutlivesViewerThatLeaves) {
  Pair pair = joined(small_scene());
  pair.reader->ask_pause(true);
  pair.reader.reset();
  EXPECT_FALSE(pair.run->watch_viewers());
  EXPECT_TRUE(pair.run->pause_asked());
}

TEST(Share, PauseOfRealTimeRunOutlivesDeadViewer) {
  session::SharedScene scene = small_scene();
  scene.wall_clock = true;
  const Pair pair = joined(scene);
  viewer_that_is_killed(pair, [](auto& viewer) { viewer.ask_pause(true); });
  EXPECT_FALSE(pair.run->watch_viewers());
  EXPECT_TRUE(pair.run->pause_asked());
}

TEST(Share, ForgetsViewersThatDied) {
  const Pair pair = joined(small_scene());
  viewer_that_is_killed(pair, [](auto&) {});
  EXPECT_EQ(pair.run->viewers().size(), 2U);
  pair.run->watch_viewers();
  EXPECT_EQ(pair.run->viewers().size(), 1U) << "the reader of this test";
}

/// A file in the folder of shared memory that is not shared memory; removed by the destructor. A
/// process that hangs on it is ended by SIGALRM.
class WrongFile {
 public:
  explicit WrongFile(std::string path) : path_(std::move(path)) {
    alarm(60);
    EXPECT_EQ(mkfifo(path_.c_str(), 0600), 0) << path_;
  }
  ~WrongFile() {
    alarm(0);
    unlink(path_.c_str());
  }
  WrongFile(const WrongFile&) = delete;
  WrongFile& operator=(const WrongFile&) = delete;

 private:
  std::string path_;
};

std::string shared_path(const std::string& name) {
  return "/dev/shm/thimble-" + std::to_string(geteuid()) + "-" + name;
}

bool is_listed(const std::string& name) {
  const auto runs = session::running_runs();
  return std::any_of(runs.begin(), runs.end(), [&](const auto& run) { return run.name == name; });
}

TEST(Share, RunRemovesNoOtherRunOfItsName) {
  const std::string name = name_for("again");
  auto first = session::SharedRun::create(name, small_scene(), 10).value();
  ASSERT_EQ(unlink(shared_path(name).c_str()), 0);
  const auto second = session::SharedRun::create(name, small_scene(), 10).value();
  first.reset();
  EXPECT_TRUE(is_listed(name));
}

TEST(Share, FifoDoesNotHangList) {
  const std::string name = name_for("fifo");
  const WrongFile fifo(shared_path(name));
  EXPECT_FALSE(is_listed(name));
  session::remove_dead_runs();
  EXPECT_FALSE(session::SharedReader::attach(name));
}

TEST(Share, FifoOfItsNameDoesNotStopRun) {
  const std::string name = name_for("fifo");
  const WrongFile fifo(shared_path(name));
  const auto run = session::SharedRun::create(name, small_scene(), 10);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ((*run)->name(), name);
  EXPECT_TRUE(is_listed(name));
  EXPECT_TRUE(session::SharedReader::attach(name));
  EXPECT_FALSE(session::SharedRun::create(name, small_scene(), 10)) << "it is shown already";
}

TEST(Share, FifoDoesNotKeepNextRunFromName) {
  const std::string name = name_for("fifo");
  const WrongFile fifo(shared_path(name)), next_fifo(shared_path(name) + ".next");
  const auto run = session::SharedRun::create(name, small_scene(), 10).value();
  session::SharedScene other = small_scene();
  other.name = "other";
  const auto next = session::SharedRun::create_next(*run, other, 10);
  ASSERT_TRUE(next) << next.error().message;
  EXPECT_EQ(session::SharedReader::attach(name).value()->scene().name, "other");
}

TEST(Share, FileOfAnotherUserDoesNotStopRun) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may act as another user";
  const std::string name = name_for("foreign");
  const std::string path = shared_path(name);
  const pid_t other = fork();
  if (other == 0) {
    const bool is_other = setgid(65534) == 0 && setuid(65534) == 0;
    if (!is_other) _exit(1);
    const int made = open(path.c_str(), O_CREAT | O_EXCL | O_RDWR, 0600);
    _exit(made >= 0 ? 0 : errno == EACCES ? 2 : 1);
  }
  int status = 0;
  waitpid(other, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2) {
    GTEST_SKIP() << "only root may write to /dev/shm here, as in some changed roots";
  }
  ASSERT_EQ(status, 0);
  {
    const auto run = session::SharedRun::create(name, small_scene(), 10);
    ASSERT_TRUE(run) << run.error().message;
    EXPECT_TRUE(session::SharedReader::attach(name));
  }
  EXPECT_FALSE(session::run_name_taken(name)) << "what is left is not ours";
  unlink(path.c_str());
}

/// Runs `work` in a separate PID namespace with the same /dev/shm, as in a container that shares
/// the host's IPC. Returns its exit code; empty if the kernel forbids such a namespace.
template <class Work>
std::optional<int> in_another_pid_namespace(Work work) {
  constexpr int kForbidden = 99;
  const pid_t maker = fork();
  if (maker == 0) {
    const uid_t user = geteuid();
    const gid_t group = getegid();
    if (unshare(CLONE_NEWUSER | CLONE_NEWPID | CLONE_NEWNS) != 0) _exit(kForbidden);
    std::ofstream("/proc/self/setgroups") << "deny";
    std::ofstream("/proc/self/uid_map") << user << ' ' << user << " 1";
    std::ofstream("/proc/self/gid_map") << group << ' ' << group << " 1";
    const pid_t first = fork();
    if (first == 0) {
      if (mount("proc", "/proc", "proc", 0, nullptr) != 0) _exit(kForbidden);
      _exit(work());
    }
    int status = 0;
    waitpid(first, &status, 0);
    _exit(WIFEXITED(status) ? WEXITSTATUS(status) : kForbidden);
  }
  int status = 0;
  waitpid(maker, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) == kForbidden) return {};
  return WEXITSTATUS(status);
}

TEST(Share, LiveRunIsKeptByOtherPidNamespace) {
  const std::string name = name_for("namespaces");
  const auto run = session::SharedRun::create(name, small_scene(), 10).value();
  const auto listed = in_another_pid_namespace([&] {
    session::remove_dead_runs();
    return is_listed(name) ? 1 : 0;
  });
  if (!listed) GTEST_SKIP() << "the kernel gives no PID namespace here";
  EXPECT_EQ(*listed, 1) << "it is alive there too";
  EXPECT_TRUE(is_listed(name));
}

TEST(Share, LiveViewerIsKeptByRunInOtherPidNamespace) {
  const std::string name = name_for("namespaces");
  const auto run = session::SharedRun::create(name, small_scene(), 10).value();
  std::array<int, 2> ready{}, done{};
  ASSERT_EQ(pipe(ready.data()), 0);
  ASSERT_EQ(pipe(done.data()), 0);
  char one = 0;
  std::thread other([&] {
    const auto result = in_another_pid_namespace([&] {
      const auto viewer = session::SharedReader::attach(name).value();
      viewer->ask_pause(true);
      if (!viewer->lead_hand({1, 2, 3}, true)) return 1;
      if (write(ready[1], "y", 1) != 1) return 2;
      return read(done[0], &one, 1) == 1 ? 0 : 3;
    });
    if (!result) static_cast<void>(write(ready[1], "n", 1));
  });
  char answer = 0;
  EXPECT_EQ(read(ready[0], &answer, 1), 1);
  run->watch_viewers();
  session::SharedHand hand;
  const bool held = run->hand(hand) && hand.active == 1;
  const bool paused = run->pause_asked();
  EXPECT_EQ(write(done[1], "x", 1), 1);
  other.join();
  if (answer == 'n') GTEST_SKIP() << "the kernel gives no PID namespace here";
  EXPECT_TRUE(held);
  EXPECT_TRUE(paused);
}

TEST(Share, IsPrivateAndRemovedAfterwards) {
  const std::string name = name_for("private");
  const std::string path = "/dev/shm/thimble-" + std::to_string(geteuid()) + "-" + name;
  {
    const auto run = session::SharedRun::create(name, small_scene(), 10).value();
    struct stat status {};
    ASSERT_EQ(stat(path.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0600U);
    EXPECT_EQ(session::SharedReader::attach(name).value()->name(), name);
    const auto second = session::SharedRun::create(name, small_scene(), 10);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("already shared"), std::string::npos);
    bool listed = false;
    for (const session::RunningRun& one : session::running_runs()) listed |= one.name == name;
    EXPECT_TRUE(listed);
  }
  struct stat status {};
  EXPECT_NE(stat(path.c_str(), &status), 0);
  const auto gone = session::SharedReader::attach(name);
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().message.find("--list"), std::string::npos) << gone.error().message;
}

TEST(Share, NamePassesToTheNextRunAtomically) {
  const std::string name = name_for("next");
  auto run = session::SharedRun::create(name, small_scene(), 10).value();
  session::SharedScene other = small_scene();
  other.name = "other";
  {
    // Complete, but without its name yet: it is invisible, and viewers find the previous run.
    const auto memory = session::SharedMemory::create_next(run->memory(), 1 << 20).value();
    int listed = 0;
    for (const session::RunningRun& one : session::running_runs()) {
      listed += one.name.starts_with(name) ? 1 : 0;
    }
    EXPECT_EQ(listed, 1);
    EXPECT_EQ(session::SharedReader::attach(name).value()->scene().name, "small");
  }
  auto next = session::SharedRun::create_next(*run, other, 10).value();
  EXPECT_EQ(next->name(), name);
  EXPECT_EQ(session::SharedReader::attach(name).value()->scene().name, "other");
  run.reset();
  EXPECT_TRUE(session::SharedReader::attach(name)) << "the name was not its own any more";
  next.reset();
  EXPECT_FALSE(session::SharedReader::attach(name));
}

TEST(Share, RequestsToAFinishedRunAreRejected) {
  session::SharedScene scene = small_scene();
  scene.paced = scene.restarts = true;
  const Pair pair = joined(scene);
  ASSERT_TRUE(pair.reader->ask_restart("/kept.yaml"));
  EXPECT_TRUE(pair.reader->check_accepted());
  pair.run->close();
  EXPECT_EQ(pair.run->restart_request_after(0)->scene, "/kept.yaml") << "requested before";
  for (const auto& answer : {pair.reader->check_accepted(), pair.reader->ask_restart("/lost.yaml"),
                             pair.reader->ask_loop(true), pair.reader->ask_speed(2)}) {
    ASSERT_FALSE(answer);
    EXPECT_NE(answer.error().message.find("try again"), std::string::npos);
  }
  EXPECT_EQ(pair.run->restart_request_after(0)->scene, "/kept.yaml");
}

TEST(Share, ReportsAndRemovesAKilledRun) {
  const std::string name = name_for("killed");
  std::array<int, 2> pipe_ends{};
  ASSERT_EQ(pipe(pipe_ends.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a failing test leaves no process behind
    const auto run = session::SharedRun::create(name, small_scene(), 10).value();
    run->set_state(session::RunState::kRunning);
    static_cast<void>(write(pipe_ends[1], "x", 1));
    for (;;) pause();
  }
  char ready = 0;
  ASSERT_EQ(read(pipe_ends[0], &ready, 1), 1);
  auto attached = session::SharedReader::attach(name);
  ASSERT_TRUE(attached) << attached.error().message;
  const auto reader = std::move(attached).value();
  EXPECT_EQ(reader->state(), session::RunState::kRunning);
  EXPECT_FALSE(reader->died());
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(reader->died());
  EXPECT_EQ(reader->state(), session::RunState::kEnded);
  for (const session::RunningRun& one : session::running_runs()) EXPECT_NE(one.name, name);
  // Its name is free again.
  EXPECT_TRUE(session::SharedRun::create(name, small_scene(), 10));
}

/// Returns a copy of a run's memory, aligned as the original.
struct Copy {
  explicit Copy(std::span<const std::byte> from)
      : words(from.size() / 8 + 8), bytes(aligned(), from.size()) {
    std::memcpy(bytes.data(), from.data(), from.size());
  }
  std::byte* aligned() {
    auto at = reinterpret_cast<std::uintptr_t>(words.data());
    return reinterpret_cast<std::byte*>((at + 63) / 64 * 64);
  }
  std::vector<std::uint64_t> words;
  std::span<std::byte> bytes;
};

/// Calls all functions of a reader.
void read_all(session::SharedReader& reader) {
  TickRecord tick;
  static_cast<void>(reader.newest(tick));
  std::uint64_t serial = 0;
  std::vector<TickRecord> ticks;
  reader.ticks_since(serial, ticks);
  session::ScenePoses poses;
  static_cast<void>(reader.poses(poses));
  render::BodyPatch patch{};
  static_cast<void>(reader.patch(patch));
  for (std::size_t i = 0; i < reader.scene().objects.size(); ++i) {
    render::TriangleMesh mesh = mesh_of(reader.scene(), i);
    reader.shape(i, mesh);
    for (const auto& corners : mesh.triangles) {
      for (const std::int32_t vertex : corners) {
        EXPECT_TRUE(vertex >= 0 && static_cast<std::size_t>(vertex) < mesh.vertices.size());
      }
    }
  }
  for (std::size_t i = 0; i < reader.scene().knobs.size(); ++i) {
    const double value = reader.knob(i);
    EXPECT_TRUE(value >= reader.scene().knobs[i].min && value <= reader.scene().knobs[i].max);
  }
  static_cast<void>(reader.counters());
  static_cast<void>(reader.recording_path());
  static_cast<void>(reader.state());
  static_cast<void>(session::arm_lines(reader.scene().arms.front(), tick));
}

TEST(Share, RejectsAnotherLayoutFirst) {
  const Pair pair = joined(small_scene());
  Copy copy(pair.run->memory().bytes());
  // Only the two words with fixed offsets are valid.
  std::memset(copy.bytes.data() + sizeof(std::uint64_t), 0x41, copy.bytes.size() - 8);
  const auto reader = session::SharedReader::over(copy.bytes);
  ASSERT_FALSE(reader);
  EXPECT_NE(reader.error().message.find("different builds"), std::string::npos)
      << reader.error().message;
}

TEST(Share, RejectsEveryFlippedByteOfConstantData) {
  const Pair pair = joined(small_scene());
  Copy copy(pair.run->memory().bytes());
  const auto& head = *reinterpret_cast<const session::SharedHead*>(copy.bytes.data());
  const auto refused = [&](std::size_t at) {
    copy.bytes[at] ^= std::byte{0x41};
    EXPECT_FALSE(session::SharedReader::over(copy.bytes)) << "byte " << at;
    copy.bytes[at] ^= std::byte{0x41};
  };
  for (std::size_t at = 0; at < sizeof(session::SharedHead); ++at) refused(at);
  for (std::size_t at = head.objects.offset;
       at < head.map_values.offset + head.map_values.count * sizeof(float); ++at) {
    // The bytes between two tables are not read.
    for (const auto& [table, size] : {std::pair(head.objects, sizeof(session::SharedObject)),
                                      std::pair(head.knobs, sizeof(session::SharedKnob)),
                                      std::pair(head.vertices, sizeof(session::SharedVertex)),
                                      std::pair(head.triangles, sizeof(session::SharedTriangle)),
                                      std::pair(head.map_values, sizeof(float))}) {
      if (at >= table.offset && at < table.offset + table.count * size) refused(at);
    }
  }
  EXPECT_TRUE(session::SharedReader::over(copy.bytes)) << "unchanged";
}

TEST(Share, ReadsInvalidLiveDataSafely) {
  const Pair pair = joined(small_scene());
  for (std::uint64_t i = 0; i < 150; ++i) pair.run->store_tick(tick_number(i));
  pair.run->store_patch({});
  pair.run->store_poses({});
  pair.run->store_split(0, {.vertex = 3, .ends = {0, 1}, .triangles = {0, 1}, .others = {2, 3}});
  Copy copy(pair.run->memory().bytes());
  const auto reader = session::SharedReader::over(copy.bytes).value();
  read_all(*reader);
  EXPECT_EQ(reader->rejected(), 0U);
  std::mt19937_64 random(support::seed_of(1));
  const std::size_t begin = session::kSharedLiveOffset;
  const auto& tables = *reinterpret_cast<const session::SharedHead*>(copy.bytes.data());
  for (int round = 0; round < 200; ++round) {
    const int flips = 1 << random() % 12;
    for (int i = 0; i < flips; ++i) {
      const std::size_t at = begin + random() % (copy.bytes.size() - begin);
      if (at >= tables.objects.offset && at < tables.shaped.offset) continue;
      copy.bytes[at] = static_cast<std::byte>(random());
    }
    read_all(*reader);
  }
  EXPECT_GT(reader->rejected(), 0U) << "nothing was put to the test";
}

TEST(Share, RejectsTruncatedMemory) {
  const Pair pair = joined(small_scene());
  for (std::size_t bytes = 0; bytes < pair.run->memory().bytes().size(); bytes += 613) {
    Copy copy(pair.run->memory().bytes().first(bytes));
    EXPECT_FALSE(session::SharedReader::over(copy.bytes)) << bytes;
  }
}

TEST(Share, SurvivesTruncationOfMappedMemory) {
  const std::string name = name_for("cut");
  const auto run = session::SharedRun::create(name, small_scene(), 100).value();
  for (std::uint64_t i = 0; i < 150; ++i) run->store_tick(tick_number(i));
  const auto reader = session::SharedReader::attach(name).value();
  read_all(*reader);
  EXPECT_FALSE(reader->died());
  const std::string path = shared_path(name);
  ASSERT_EQ(truncate(path.c_str(), 100), 0);
  read_all(*reader);
  EXPECT_TRUE(reader->died());
  EXPECT_EQ(reader->state(), session::RunState::kEnded);
  run->store_tick(tick_number(150));  // the servo survives it too
  EXPECT_TRUE(run->memory().broken());
  EXPECT_FALSE(session::SharedReader::attach(name)) << "no other viewer can attach";
}

TEST(KnobOrder, ChangesTheNamedKnobAndListsKnobs) {
  const Pair pair = joined(small_scene());
  ASSERT_TRUE(session::turn_knob(*pair.reader, "stiff: stiffness=300.5"));
  EXPECT_EQ(pair.run->knob_wanted(0), 300.5);
  for (const char* order : {"stiff: stiffness", "stiff: stiffness=", "stiff: stiffness=1 N/m",
                            "stiff: stiffness=nan", ""}) {
    SCOPED_TRACE(order);
    const auto wrong = session::turn_knob(*pair.reader, order);
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().message.find("expected NAME=VALUE"), std::string::npos);
  }
  for (const char* order : {"stiff: stiffness=5000", "stiff: stiffness=-1"}) {
    const auto beyond = session::turn_knob(*pair.reader, order);
    ASSERT_FALSE(beyond) << order;
    EXPECT_NE(beyond.error().message.find("stiff: stiffness must be "), std::string::npos);
  }
  EXPECT_EQ(pair.run->knob_wanted(0), 300.5);
  const auto unknown = session::turn_knob(*pair.reader, "soft: stiffness=1");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("stiff: stiffness"), std::string::npos);
  EXPECT_EQ(pair.run->knob_wanted(0), 300.5);
}

TEST(Share, ShowsTheKindOfEachObject) {
  session::SharedScene scene = small_scene();
  scene.objects[0].kind = session::SharedKind::kField;
  const Pair pair = joined(scene);
  EXPECT_EQ(pair.reader->scene().objects[0].kind, session::SharedKind::kField);
  EXPECT_EQ(pair.reader->scene().objects[1].kind, session::SharedKind::kMesh);
}

TEST(Share, KeepsEachYesAndNoOfATick) {
  const Pair pair = joined(small_scene());
  bool TickRecord::*const all[] = {&TickRecord::in_contact, &TickRecord::fresh,
                                   &TickRecord::has_gripper, &TickRecord::home_needed};
  for (const auto one : all) {
    for (const bool value : {true, false}) {
      TickRecord stored, seen;
      for (const auto other : all) stored.*other = !value;
      stored.*one = value;
      pair.run->store_tick(stored);
      ASSERT_TRUE(pair.reader->newest(seen));
      for (const auto other : all) EXPECT_EQ(seen.*other, stored.*other);
    }
  }
}

TEST(Share, RejectsATickWithAnUnknownState) {
  const Pair pair = joined(small_scene());
  TickRecord stage, fault, link, before_none, beyond_last;
  stage.stage = static_cast<driver::DeviceStage>(static_cast<int>(driver::kLastStage) + 1);
  fault.fault = static_cast<driver::Fault>(static_cast<int>(driver::kLastFault) + 1);
  link.link = static_cast<driver::LinkState>(static_cast<int>(driver::kLastLinkState) + 1);
  before_none.object = -2;
  beyond_last.object = 2;
  std::uint64_t rejected = 0;
  for (const TickRecord& wrong : {stage, fault, link, before_none, beyond_last}) {
    pair.run->store_tick(wrong);
    TickRecord seen;
    EXPECT_FALSE(pair.reader->newest(seen)) << rejected;
    EXPECT_EQ(pair.reader->rejected(), ++rejected);
  }
}

// A bool whose byte is neither 0 nor 1 may not be read as one.
TEST(Share, InvalidByteOfABoolIsFalse) {
  const Pair pair = joined(small_scene());
  render::BodyPatch stored{}, seen{};
  unsigned char byte = 2;
  std::memcpy(&stored.complete, &byte, 1);
  pair.run->store_patch(stored);
  ASSERT_TRUE(pair.reader->patch(seen));
  std::memcpy(&byte, &seen.complete, 1);
  EXPECT_EQ(byte, 0);
}

TEST(Share, NamesTheLayoutOfTheShortestHeader) {
  struct alignas(64) Header {
    std::uint64_t ready = session::kSharedReady, layout = 7;
  } header;
  const auto read = session::read_shared_scene(std::as_bytes(std::span(&header, 1)).first(16));
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("memory layout 7"), std::string::npos)
      << read.error().message;
}

// The descriptor of the memory is then 0.
TEST(Share, AttachesWithoutStandardInput) {
  const std::string name = name_for("no-input");
  const auto run = session::SharedRun::create(name, small_scene(), 10).value();
  const int input = fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
  close(STDIN_FILENO);
  const bool attached = session::SharedReader::attach(name).ok();
  dup2(input, STDIN_FILENO);
  close(input);
  EXPECT_TRUE(attached);
}

TEST(RunAttachment, AttachesToTheNamedRunOnce) {
  const std::string name = name_for("attach");
  const auto run = session::SharedRun::create(name, small_scene(), 10).value();
  session::RunAttachment attachment(name);
  EXPECT_TRUE(attachment.step());
  ASSERT_NE(attachment.reader(), nullptr);
  EXPECT_EQ(attachment.reader()->scene().name, "small");
  EXPECT_FALSE(attachment.step()) << "it is attached";
  EXPECT_FALSE(attachment.over());
  EXPECT_EQ(attachment.notice(), "");
}

TEST(RunAttachment, KeepsTheNameOfTheRunItFound) {
  const std::string name = name_for("found");
  const auto run = session::SharedRun::create(name, small_scene(), 10).value();
  session::RunAttachment attachment("");
  if (session::running_runs().front().name != name) GTEST_SKIP() << "another run is newer";
  ASSERT_TRUE(attachment.step());
  EXPECT_EQ(attachment.name(), name);
}

TEST(RunAttachment, SearchesAtMostFourTimesASecond) {
  const std::string name = name_for("later");
  session::RunAttachment attachment(name);
  EXPECT_FALSE(attachment.step());
  EXPECT_EQ(attachment.notice(), "Waiting for a run named " + name + ".");
  const auto run = session::SharedRun::create(name, small_scene(), 10).value();
  EXPECT_FALSE(attachment.step()) << "it has just searched";
  std::this_thread::sleep_for(std::chrono::milliseconds(260));
  EXPECT_TRUE(attachment.step());
}

}  // namespace
}  // namespace thimble::session
