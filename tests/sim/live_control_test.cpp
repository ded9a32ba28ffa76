#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "hand/hand.h"
#include "run_law.h"
#include "run_records.h"
#include "setup.h"
#include "share/describe_scene.h"
#include "share/live_control.h"
#include "share/live_knobs.h"
#include "share/shared_reader.h"
#include "support/covered.h"
#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/meshes/elephant.h"
#include "support/run_hash.h"
#include "support/scratch.h"
#include "support/shipped_scene.h"
#include "support/shipped_scenes.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

using session::SessionOptions;

std::filesystem::path shipped(const std::string& name) {
  return std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" / (name + ".yaml");
}

/// Writes the rubber ball with one coefficient of friction instead of two. With stiction, two
/// copies with a tiny difference slip in different ticks, and the jump of the friction would be
/// attributed to the knob.
std::filesystem::path rubber_that_does_not_jump() {
  std::ifstream from(shipped("rubber"));
  std::string text((std::istreambuf_iterator<char>(from)), {});
  const auto line = text.find("        static_coefficient");
  text.erase(line, text.find('\n', line) + 1 - line);
  const auto path = support::scratch_folder() / "rubber.yaml";
  std::ofstream(path) << text;
  return path;
}

std::unique_ptr<session::Session> open(const std::filesystem::path& scene,
                                       const SessionOptions& options) {
  auto opened = session::Session::open(scene, options);
  if (!opened) {
    ADD_FAILURE() << opened.error().message;
    return nullptr;
  }
  return std::move(opened).value();
}

std::unique_ptr<session::SharedReader> reader_of(session::Session& session) {
  return session::SharedReader::over(session.shared()->memory().again().value()).value();
}

std::uint64_t hash_of(const session::Session& session) {
  support::RunHash hash;
  for (const auto& row : session.ticks()) hash.add(row);
  return hash.value();
}

/// A copy of a scene's force law with its knobs.
struct Copy {
  explicit Copy(const scene::Scene& scene)
      : objects(scene::SceneObjects::build(scene).value()), knobs(scene, objects->touch()) {}
  std::unique_ptr<scene::SceneObjects> objects;
  session::LiveKnobs knobs;
};

driver::DeviceState state_of(const driver::TickRecord& row, double dt) {
  driver::DeviceState state;
  state.time_ns = row.time_ns;
  state.tick = row.tick;
  state.dt = dt;
  state.p_WT = {row.p_WT[0], row.p_WT[1], row.p_WT[2]};
  state.v_WT = {row.v_WT[0], row.v_WT[1], row.v_WT[2]};
  state.fresh = row.fresh;
  return state;
}

driver::TickRecord reported(const driver::DeviceState& state, const driver::ForceCommand& command) {
  driver::TickRecord record;
  record.v_WT = {state.v_WT.x(), state.v_WT.y(), state.v_WT.z()};
  record.f_wanted_W = {command.f_T_W.x(), command.f_T_W.y(), command.f_T_W.z()};
  record.depth = command.touch.depth;
  record.in_contact = command.touch.in_contact;
  return record;
}

/// Effect of a knob on the force.
struct Turned {
  double largest_step = 0;  // max. change of the force due to the knob's change in one tick, N
  double range = 0;         // range of the values, relative to their bounds
  double felt = 0;          // max. difference from the force without the change, N
};

/// Feeds the states of a run to two copies of its scene; the knob of the second copy is always one
/// tick behind. So the difference of their forces is the effect of the knob in a tick.
Turned turn(const std::filesystem::path& scene_file, const std::string& knob_name) {
  Turned turned;
  SessionOptions options;
  options.mesh_folder = THIMBLE_MESHES;
  const auto session = open(scene_file, options);
  if (!session) return turned;
  session->run(std::atomic<bool>{false});
  const scene::Scene& scene = session->scene();
  Copy now(scene), before(scene), plain(scene);

  session::SharedScene described = session::describe_scene(scene, *now.objects, "test");
  described.period_ns = session->setup().period_ns();
  described.knobs = now.knobs.described();
  const auto shared = session::SharedRun::create("", described, 10).value();
  const auto reader = session::SharedReader::over(shared->memory().again().value()).value();
  std::size_t knob = described.knobs.size();
  for (std::size_t i = 0; i < described.knobs.size(); ++i) {
    if (described.knobs[i].name == knob_name) knob = i;
  }
  if (knob == described.knobs.size()) {
    ADD_FAILURE() << scene_file << " has no knob " << knob_name;
    return turned;
  }
  const auto& bounds = described.knobs[knob];
  const double dt = 1e-9 * static_cast<double>(session->setup().period_ns());
  driver::TickRecord last;
  double lowest = bounds.initial, highest = bounds.initial;
  for (const auto& row : session->ticks()) {
    reader->turn_knob(knob, row.tick / 400 % 2 == 0 ? bounds.max : bounds.min);
    const driver::DeviceState state = state_of(row, dt);
    now.knobs.step(*shared, last, dt);
    const auto f_now = now.objects->touch()(state);
    const auto f_before = before.objects->touch()(state);
    const auto f_plain = plain.objects->touch()(state);
    before.knobs.step(*shared, last, dt);
    turned.largest_step = std::max(turned.largest_step, (f_now.f_T_W - f_before.f_T_W).norm());
    turned.felt = std::max(turned.felt, (f_now.f_T_W - f_plain.f_T_W).norm());
    lowest = std::min(lowest, now.knobs.value(knob));
    highest = std::max(highest, now.knobs.value(knob));
    last = reported(state, f_now);
  }
  turned.range = (highest - lowest) / (bounds.max - bounds.min);
  return turned;
}

TEST(LiveKnobs, ForceHasNoStepsWhileAKnobTurns) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "this test uses no threads";
#endif
  const double most = session::LiveKnobs::kForceRate * 1e-3;  // N in a tick of 1 kHz
  const std::filesystem::path rubber = rubber_that_does_not_jump();
  for (const auto& [scene, knob] :
       {std::pair(rubber, "ball: stiffness"), std::pair(rubber, "ball: damping"),
        std::pair(rubber, "ball: friction coefficient"),
        std::pair(shipped("sandpaper"), "sandpaper: texture roughness"),
        std::pair(shipped("sandpaper"), "ribs: texture gain"),
        std::pair(shipped("honey"), "honey: damping"),
        std::pair(shipped("clay"), "ball: stiffness")}) {
    SCOPED_TRACE(scene.stem().string() + ", " + knob);
    const Turned turned = turn(scene, knob);
    EXPECT_LE(turned.largest_step, most);
    EXPECT_GT(turned.felt, 0.1) << "the knob had no effect on the force";
    EXPECT_GT(turned.range, 0.9) << "the knob did not cover its range";
    std::printf("%s, %s: at most %.4f N in a tick due to the knob (allowed %.3f)\n",
                scene.stem().c_str(), knob, turned.largest_step, most);
  }
}

class KnobsOfScene : public ::testing::TestWithParam<std::string> {};

// Bodies that move or dent change their depth faster than in the last tick. If static friction is
// higher than sliding friction, a knob makes the tip slip a tick earlier or later: that step
// belongs to the law.
TEST_P(KnobsOfScene, ForceChangesStayWithinTheStatedLimit) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "this test uses no threads";
#endif
  if (GetParam() == "elephant") THIMBLE_NEEDS_MESHES();
  const bool slips = GetParam() == "rubber" || GetParam() == "tin_can";
  const double most = slips ? 0.8 : 0.06;  // N per tick
  std::vector<std::string> knobs;
  {
    SessionOptions options;
    options.share = true;
    options.mesh_folder = THIMBLE_MESHES;
    const auto session = open(support::scene_file(GetParam()), options);
    ASSERT_TRUE(session);
    const auto reader = reader_of(*session);
    for (const auto& knob : reader->scene().knobs) knobs.push_back(knob.name);
  }
  for (const std::string& knob : knobs) {
    const Turned turned = turn(support::scene_file(GetParam()), knob);
    std::printf("%s, %s: %.4f N in a tick\n", GetParam().c_str(), knob.c_str(),
                turned.largest_step);
    EXPECT_LE(turned.largest_step, most) << knob;
  }
  support::Covered("scenes").add(GetParam());
}

INSTANTIATE_TEST_SUITE_P(ByName, KnobsOfScene, ::testing::ValuesIn(support::scenes_of_one_arm()),
                         [](const auto& scene) { return scene.param; });

TEST(LiveKnobs, ReachTheirTargetWithoutHeap) {
  SessionOptions options;
  options.share = true;
  const auto session = open(shipped("rubber"), options);
  const auto reader = reader_of(*session);
  Copy copy(session->scene());
  reader->turn_knob(0, 123);
  driver::TickRecord last;
  last.in_contact = true;
  last.depth = 0.005;
  const int calls = support::heap_calls_of([&] {
    for (int i = 0; i < 1000; ++i) copy.knobs.step(*session->shared(), last, 1e-3);
  });
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(copy.knobs.value(0), 123);
  EXPECT_EQ(reader->knob(0), 123);
}

TEST(ProgramKnobs, ReachTheirTargetWithoutHeap) {
  SessionOptions options;
  const auto plain = open(shipped("rubber"), options);
  EXPECT_TRUE(plain->knobs().empty());
  EXPECT_FALSE(plain->turn_knob("ball: stiffness", 123));
  options.knobs = true;
  const auto session = open(shipped("rubber"), options);
  ASSERT_EQ(session->knobs()[0].name, "ball: stiffness");
  EXPECT_FALSE(session->turn_knob("ball: stiffness", -1));
  EXPECT_FALSE(session->turn_knob("ball: stiffness", std::nan("")));
  EXPECT_FALSE(session->turn_knob("no such knob", 1));
  ASSERT_TRUE(session->turn_knob("ball: stiffness", 123));
  EXPECT_NE(session->knobs()[0].value, 123);
  driver::DeviceState state;
  state.p_WT = {0, 0, 0.04};
  state.dt = 1e-3;
  const driver::ForceLaw law = session->own_law();
  const int calls = support::heap_calls_of([&] {
    for (int i = 0; i < 1000; ++i) law(state);
  });
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(session->knobs()[0].value, 123);
  ASSERT_TRUE(session->turn_knob("ball: stiffness", 200));  // again, after it has settled
  for (int i = 0; i < 1000; ++i) law(state);
  EXPECT_EQ(session->knobs()[0].value, 200);
}

TEST(LiveKnobs, LoopIsStableAtBothEndsOfEveryKnob) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "this test uses no threads";
#endif
  std::vector<std::string> scenes{"rubber", "sandpaper", "honey"};
  if (support::long_form()) {
    scenes.insert(scenes.end(), {"clay", "floating_block", "trampoline"});
  }
  for (const std::string& name : scenes) {
    SessionOptions options;
    options.share = true;
    options.duration = 3;
    const auto first = open(shipped(name), options);
    ASSERT_TRUE(first);
    const std::size_t knobs = reader_of(*first)->scene().knobs.size();
    EXPECT_GT(knobs, 0u) << name;
    for (std::size_t turned = 0; turned < 2 * knobs; ++turned) {
      const auto session = open(shipped(name), options);
      const auto reader = reader_of(*session);
      const auto& knob = reader->scene().knobs[turned / 2];
      SCOPED_TRACE(name + ", " + knob.name);
      reader->turn_knob(turned / 2, turned % 2 == 0 ? knob.min : knob.max);
      session->run(std::atomic<bool>{false});
      EXPECT_EQ(session->device().fault(), driver::Fault::kNone);
      // Dissipation continues; 1 uJ is the effect of rounding and encoder counts.
      EXPECT_LT(session->statistics().energy_to_hand(), 1e-6);
    }
  }
}

TEST(LiveControl, PassiveViewerLeavesTheRunBitIdentical) {
  for (const char* name : {"rubber", "clay", "floating_block", "water_balloon"}) {
    SCOPED_TRACE(name);
    SessionOptions options;
    options.duration = 2;
    const auto alone = open(shipped(name), options);
    options.share = true;
    const auto shared = open(shipped(name), options);
    ASSERT_TRUE(alone && shared);
    alone->run(std::atomic<bool>{false});
    std::atomic<bool> ended{false};
    std::thread viewer([&] {
      const auto reader = reader_of(*shared);
      std::uint64_t serial = 0;
      std::vector<driver::TickRecord> ticks;
      while (!ended.load()) {
        ticks.clear();
        reader->ticks_since(serial, ticks);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      driver::TickRecord last;
      EXPECT_TRUE(reader->newest(last));
      EXPECT_EQ(last.tick, shared->ticks().back().tick);
      EXPECT_EQ(reader->rejected(), 0u);
    });
    shared->run(std::atomic<bool>{false});
    ended.store(true);
    viewer.join();
    EXPECT_EQ(hash_of(*alone), hash_of(*shared));
  }
}

TEST(LiveControl, ShowsShapedAndMovedObjectsWhereTheyAre) {
  SessionOptions options;
  options.share = true;
  options.duration = 3;
  const auto clay = open(shipped("clay"), options);
  const auto reader = reader_of(*clay);
  clay->run(std::atomic<bool>{false});
  render::TriangleMesh seen_shape = clay->setup().objects().mesh_W(0);
  const auto first = seen_shape.vertices;
  reader->shape(0, seen_shape);
  EXPECT_NE(seen_shape.vertices, first) << "the ball must have a print";
  EXPECT_EQ(seen_shape.vertices, clay->mesh_now().vertices);

  // A shape that splits its triangles, read every 50 ticks, and only at the end.
  const auto tablet = open(shipped("clay_tablet"), options);
  const auto looker = reader_of(*tablet);
  render::TriangleMesh followed = tablet->setup().objects().mesh_W(0), at_once = followed;
  std::size_t before = followed.triangles.size();
  int grown = 0;
  for (int i = 0; !tablet->step(); ++i) {
    if (i % 50 != 0) continue;
    looker->shape(0, followed);
    EXPECT_EQ(followed.triangles, tablet->mesh_now().triangles) << "tick " << i;
    EXPECT_EQ(followed.vertices, tablet->mesh_now().vertices) << "tick " << i;
    grown += followed.triangles.size() > before;
    before = followed.triangles.size();
  }
  EXPECT_GT(grown, 5);
  looker->shape(0, followed);
  looker->shape(0, at_once);
  const render::TriangleMesh in_the_end = tablet->mesh_now();
  EXPECT_EQ(followed.triangles, in_the_end.triangles);
  EXPECT_EQ(at_once.triangles, in_the_end.triangles);
  EXPECT_EQ(at_once.vertices, in_the_end.vertices);
  EXPECT_EQ(looker->rejected(), 0u);

  const auto block = open(shipped("floating_block"), options);
  const auto watcher = reader_of(*block);
  block->run(std::atomic<bool>{false});
  session::ScenePoses seen, real;
  ASSERT_TRUE(watcher->poses(seen));
  ASSERT_TRUE(block->records().poses);
  real = block->records().poses->now();
  EXPECT_EQ(seen.tick, real.tick);
  EXPECT_EQ(seen.pose[0].p_WB, real.pose[0].p_WB);
}

TEST(LiveControl, VirtualPauseLeavesTheRunBitIdentical) {
  SessionOptions options;
  options.duration = 2;
  const auto alone = open(shipped("rubber"), options);
  alone->run(std::atomic<bool>{false});
  options.share = true;
  const auto paused = open(shipped("rubber"), options);
  const auto reader = reader_of(*paused);
  reader->ask_pause(true);
  std::thread servo([&] { paused->run(std::atomic<bool>{false}); });
  while (reader->state() != session::RunState::kPaused) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const std::uint64_t ticks = reader->counters().ticks;
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_EQ(reader->counters().ticks, ticks) << "no ticks during a pause";
  EXPECT_LT(ticks, 2000u);
  reader->ask_pause(false);
  servo.join();
  EXPECT_EQ(hash_of(*alone), hash_of(*paused));
}

/// Moves the hand in virtual time to a point over the ball and then into it.
TEST(LiveControl, MouseHandTouchesTheScene) {
  SessionOptions options;
  options.share = true;
  options.hand_by_mouse = true;
  options.duration = 1.5;
  const auto session = open(shipped("rubber"), options);
  const auto reader = reader_of(*session);
  EXPECT_TRUE(reader->scene().hand_by_mouse);
  // Targets far outside of the workspace and 8 mm inside the ball are limited.
  ASSERT_TRUE(reader->lead_hand({0, 0, 0.002}, true));
  session->run(std::atomic<bool>{false});
  double fastest = 0, force = 0;
  for (const auto& row : session->ticks()) {
    fastest = std::max(fastest, Eigen::Map<const Eigen::Vector3d>(row.v_WT.data()).norm());
    force = std::max(force, Eigen::Map<const Eigen::Vector3d>(row.f_sent_W.data()).norm());
  }
  const auto& end = session->ticks().back();
  EXPECT_EQ(end.tick, 1499u);
  EXPECT_TRUE(end.in_contact);
  EXPECT_GT(force, 0.5);
  EXPECT_LT(fastest, 1.5 * device_sim::Hand::kSpeedMax) << "an arm in a hand overshoots slightly";
}

TEST(LiveControl, KeysHoldButtonsOfTheArm) {
  SessionOptions options;
  options.share = true;
  options.duration = 1;
  const auto session = open(shipped("rubber"), options);
  const auto reader = reader_of(*session);
  const std::atomic<bool> never{false};
  for (int tick = 0; tick < 100; ++tick) {
    reader->hold_buttons(5);
    session->step(never);
  }
  EXPECT_EQ(session->ticks().back().buttons, 5);
  reader->hold_buttons(0);
  session->step(never);
  session->step(never);
  EXPECT_EQ(session->ticks().back().buttons, 0);
}

TEST(LiveControl, ButtonsOfAViewerThatHangsAreReleased) {
  SessionOptions options;
  options.share = true;
  options.duration = 1;
  const auto session = open(shipped("rubber"), options);
  const auto reader = reader_of(*session);
  reader->hold_buttons(2);
  session->run(std::atomic<bool>{false});
  const auto& ticks = session->ticks();
  EXPECT_EQ(ticks[100].buttons, 2);
  EXPECT_EQ(ticks[200].buttons, 0);
}

TEST(LiveControl, KeepsTheHandWithinTheWorkspace) {
  SessionOptions options;
  options.share = true;
  options.hand_by_mouse = true;
  options.duration = 3;
  const auto session = open(shipped("rubber"), options);
  const auto reader = reader_of(*session);
  ASSERT_TRUE(reader->lead_hand({5, 5, 5}, true));
  session->run(std::atomic<bool>{false});
  const auto& box = session->scene().arms.front().arm.workspace;
  for (const auto& row : session->ticks()) {
    for (int k = 0; k < 3; ++k) {
      ASSERT_LE(row.p_WT[static_cast<std::size_t>(k)], box.max_W[k] + 2e-3) << row.tick;
    }
  }
  EXPECT_EQ(session->device().fault(), driver::Fault::kNone);
}

TEST(LiveControl, PauseFadesTheForceWithoutSteps) {
  SessionOptions options;
  options.share = true;
  const auto session = open(shipped("rubber"), options);
  const auto reader = reader_of(*session);
  Copy copy(session->scene());
  session::LiveControl control(session->scene(), copy.objects->touch(), nullptr, true);
  std::atomic<bool> never{false};
  control.join(*session->shared(), false, never);
  session::SceneLaw law(copy.objects->touch());
  law.set_viewers(control, true);
  // A tip that entered the ball from above and rests there.
  driver::DeviceState state;
  state.dt = 1e-3;
  double full = 0, before = 0;
  const auto tick = [&](double z) {
    state.p_WT = {0, 0, z};
    ++state.tick;
    driver::TickRecord record;
    const driver::ForceCommand command = law(state);
    record.in_contact = command.touch.in_contact;
    record.depth = command.touch.depth;
    control.take(record);
    return command.f_T_W.norm();
  };
  for (int i = 0; i < 100; ++i) full = before = tick(0.02 - 1.5e-4 * i);
  ASSERT_GT(full, 1);
  const double most = 1.001 * full * state.dt / session::LiveControl::kFade;
  for (const bool pause : {true, false}) {
    reader->ask_pause(pause);
    for (int i = 0; i < 310; ++i) {
      const double force = tick(0.02 - 1.5e-4 * 99);
      ASSERT_LE(std::abs(force - before), most) << i;
      before = force;
    }
    EXPECT_EQ(before, pause ? 0 : full);
    EXPECT_EQ(reader->state(), pause ? session::RunState::kPaused : session::RunState::kRunning);
  }
}

// The other arms fade with the pause of the first one.
TEST(LiveControl, ArmInFaultStillLeadsThePause) {
  SessionOptions options;
  options.share = true;
  const auto session = open(shipped("rubber"), options);
  const auto reader = reader_of(*session);
  Copy copy(session->scene());
  session::LiveControl control(session->scene(), copy.objects->touch(), nullptr, true);
  std::atomic<bool> never{false};
  control.join(*session->shared(), false, never);
  session::RunLaw law(copy.objects->touch(), session->scene().arms.front().arm);
  law.scene().set_viewers(control, true);
  law.stop_in_fault(session->device());
  session->device().trip(driver::Fault::kOverSpeed);
  reader->ask_pause(true);
  driver::DeviceState state;
  state.dt = 1e-3;
  for (int i = 0; i < 310; ++i) {
    control.take({});
    law(state);
  }
  EXPECT_EQ(control.gain(), 0);
}

TEST(LiveControl, RealTimePauseHoldsTheHandWithoutForce) {
  session::SessionOptions options;
  options.clock = session::ClockKind::kWall;
  options.share = true;
  options.duration = 30;
  const auto session = open(shipped("rubber"), options);
  const auto reader = reader_of(*session);
  std::atomic<bool> stop{false};
  std::thread servo([&] { session->run(stop); });
  const auto force = [&] {
    driver::TickRecord tick;
    if (!reader->newest(tick)) return 0.0;
    return Eigen::Map<const Eigen::Vector3d>(tick.f_wanted_W.data()).norm();
  };
  // The test waits in wall-clock time but does not judge it: a fault due to a slow machine ends the
  // run.
  const auto wait_for = [&](auto condition) {
    for (int i = 0; i < 2000 && !condition() && reader->state() != session::RunState::kEnded; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  };
  wait_for([&] { return force() > 0.3; });
  reader->ask_pause(true);
  wait_for([&] { return reader->state() == session::RunState::kPaused && force() == 0; });
  const bool faulty = reader->state() == session::RunState::kEnded;
  if (!faulty) {
    EXPECT_EQ(force(), 0);
    driver::TickRecord held;
    EXPECT_TRUE(reader->newest(held));
    EXPECT_TRUE(held.in_contact) << "the hand did not move";
    reader->ask_pause(false);
    wait_for([&] { return force() > 0.3; });
  }
  stop.store(true);
  servo.join();
  if (faulty) GTEST_SKIP() << "the machine paused for longer than the arm's watchdog time";
}

}  // namespace
}  // namespace thimble
