// Sessions as used by other programs, through the public headers only.
#include "thimble/session/session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "support/scratch.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/recording.h"
#include "thimble/session/run_figures.h"
#include "thimble/session/run_statistics.h"
#include "thimble/session/servo_thread.h"

namespace thimble {
namespace {

using driver::TickRecord;

/// Makes the shipped scenes and arms available in any working folder.
class SessionTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(THIMBLE_SOURCE_DIR); }

  static std::unique_ptr<session::Session> open(const std::string& scene,
                                                const session::SessionOptions& options = {}) {
    auto opened = session::Session::open(scene, options);
    if (!opened) {
      ADD_FAILURE() << opened.error().message;
      return nullptr;
    }
    return std::move(opened).value();
  }
};

/// Counts ticks and stores the last one.
class Counter final : public session::TickObserver {
 public:
  void take(const TickRecord& record) noexcept override {
    ++ticks;
    last = record;
  }
  std::uint64_t ticks = 0;
  TickRecord last;
};

/// Half of the scene's force.
struct HalfTheForce {
  render::SceneTouch& scene;
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    driver::ForceCommand command = scene(state);
    command.f_T_W *= 0.5;
    return command;
  }
};

TEST_F(SessionTest, FindsScenesAndArmsByNameOrPath) {
  session::SessionOptions options;
  options.duration = 0.01;
  EXPECT_EQ(open("box", options)->scene().name, "box");
  EXPECT_EQ(open("app/scenes/box.yaml", options)->scene().name, "box");
  options.arm_file = "polhem";
  EXPECT_EQ(open("box", options)->scene().arms.front().arm.name, "polhem");
  const auto nowhere = session::Session::open("no_such_scene", {});
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().message.find("no_such_scene"), std::string::npos);
  options.arm_file = "no_such_arm";
  const auto no_arm = session::Session::open("box", options);
  ASSERT_FALSE(no_arm);
  EXPECT_NE(no_arm.error().message.find("no_such_arm"), std::string::npos);
}

/// Writes a scene whose tip starts at a height over the middle of a ball of 30 mm.
std::filesystem::path ball_with_start(double height) {
  const std::filesystem::path file = support::scratch_folder() / "start.yaml";
  std::ofstream(file) << "name: start\narm: vintage_phantom\nduration: 0.2\nobjects:\n"
                         "  - name: ball\n    sphere: {radius: 0.03}\n    stiffness: 500\n"
                         "hand:\n  path:\n    - {t: 0, at: [0, 0, "
                      << height << "]}\n    - {t: 0.2, at: [0.01, 0, " << height << "]}\n";
  return file;
}

TEST_F(SessionTest, ReportsATipThatStartsInside) {
  const auto inside = open(ball_with_start(0.01).string());
  ASSERT_NE(inside, nullptr);
  ASSERT_EQ(inside->warnings().size(), 1U);
  EXPECT_EQ(inside->warnings()[0],
            "The tip starts inside ball: its surface is felt only once the tip has been outside.");
  inside->run();
  const session::RunFigures figures = inside->figures();
  EXPECT_EQ(figures.inside_at_start, std::vector<std::string>{"ball"});
  EXPECT_NE(summary(figures).find("Start     the tip started inside ball"), std::string::npos);
}

TEST_F(SessionTest, RecordsThatATipStartsInside) {
  session::SessionOptions options;
  options.record = support::scratch_folder() / "start.h5";
  const auto inside = open(ball_with_start(0.01).string(), options);
  ASSERT_NE(inside, nullptr);
  inside->run();
  ASSERT_TRUE(inside->end_recording());
  const auto recording = session::read_recording(options.record);
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_EQ(recording->info.inside_at_start, "ball");
}

TEST_F(SessionTest, ReportsNoTipThatStartsOutside) {
  const auto outside = open(ball_with_start(0.05).string());
  ASSERT_NE(outside, nullptr);
  EXPECT_TRUE(outside->warnings().empty());
  EXPECT_TRUE(outside->figures().inside_at_start.empty());
}

TEST_F(SessionTest, ObserverGetsEveryTickAndChangesNothing) {
  const auto alone = open("box"), watched = open("box");
  Counter counter;
  ASSERT_TRUE(watched->add_observer(counter));
  EXPECT_EQ(alone->run(), driver::ServoEnd::kDone);
  EXPECT_EQ(watched->run(), driver::ServoEnd::kDone);
  ASSERT_EQ(alone->ticks().size(), watched->ticks().size());
  EXPECT_EQ(counter.ticks, watched->ticks().size());
  EXPECT_EQ(counter.last.tick, watched->ticks().back().tick);
  for (std::size_t i = 0; i < alone->ticks().size(); ++i) {
    ASSERT_EQ(alone->ticks()[i].f_sent_W, watched->ticks()[i].f_sent_W) << i;
  }
  EXPECT_FALSE(watched->add_observer(counter)) << "the run is over";
}

TEST_F(SessionTest, SingleStepsEqualARun) {
  const auto whole = open("box"), stepped = open("box");
  whole->run();
  std::uint64_t steps = 0;
  while (!stepped->step()) {
    TickRecord newest;
    ASSERT_TRUE(stepped->newest().load(newest));
    ASSERT_EQ(newest.tick, steps++);
  }
  EXPECT_EQ(steps, whole->ticks().size());
  EXPECT_EQ(stepped->ticks().back().p_WT, whole->ticks().back().p_WT);
}

TEST_F(SessionTest, TakesACustomLawBeforeTheFirstTick) {
  const auto own = open("box");
  HalfTheForce law{own->touch()};
  ASSERT_TRUE(own->set_law(driver::ForceLaw(law)));
  own->run();
  const auto whole = open("box");
  whole->run();
  EXPECT_GT(own->statistics().force_max(), 0.1);
  EXPECT_LT(own->statistics().force_max(), whole->statistics().force_max());
  EXPECT_GT(own->statistics().depth_max(), whole->statistics().depth_max());
  EXPECT_FALSE(own->set_law(driver::ForceLaw(law)));
  session::SessionOptions options;
  options.clock = session::ClockKind::kWall;
  const auto wall = open("box", options);
  HalfTheForce late{wall->touch()};
  EXPECT_FALSE(wall->set_law(driver::ForceLaw(late)));
}

TEST_F(SessionTest, MovesTheHandFromTickToTick) {
  const auto session = open("box");
  const Eigen::Vector3d aside(0.02, 0.03, 0.05);
  ASSERT_TRUE(session->lead_hand(aside));
  EXPECT_FALSE(session->step());
  while (!session->step()) {
  }
  const auto& end = session->ticks().back();
  EXPECT_LT((Eigen::Map<const Eigen::Vector3d>(end.p_WT.data()) - aside).norm(), 2e-3);
}

TEST_F(SessionTest, PlannedButtonsAreInTheTicks) {
  session::SessionOptions options;
  options.duration = 0.2;
  options.buttons = {{0.05, 1}, {0.1, 0}};
  const auto run = open("app/scenes/rubber.yaml", options);
  run->run();
  const auto& ticks = run->ticks();
  EXPECT_EQ(ticks[40].buttons, 0);
  EXPECT_EQ(ticks[60].buttons, 1);
  EXPECT_EQ(ticks[110].buttons, 0);
}

TEST_F(SessionTest, AButtonThatAProgramHoldsEnablesForces) {
  session::SessionOptions options;
  options.hold.buttons = 1;
  options.buttons_by_program = true;
  const auto run = open("app/scenes/rubber.yaml", options);
  const auto largest = [&] {
    double force = 0;
    for (const TickRecord& tick : run->ticks()) {
      force = std::max(force, Eigen::Map<const Eigen::Vector3d>(tick.f_sent_W.data()).norm());
    }
    return force;
  };
  while (run->ticks().size() < 1500 && !run->step()) continue;
  EXPECT_EQ(largest(), 0);
  EXPECT_TRUE(run->hold_buttons(1));
  run->run();
  EXPECT_GT(largest(), 0.3);
}

TEST_F(SessionTest, SummarisesItsFigures) {
  const auto session = open("box");
  session->run();
  const session::RunFigures figures = session->figures();
  EXPECT_EQ(figures.scene, "box");
  EXPECT_TRUE(figures.simulated_arm && figures.virtual_time && figures.zero_assured);
  EXPECT_EQ(figures.end, driver::ServoEnd::kDone);
  EXPECT_EQ(figures.fault, driver::Fault::kNone);
  EXPECT_EQ(figures.statistics.ticks(), session->ticks().size());
  EXPECT_NEAR(figures.statistics.rate(), 1000, 1e-6);
  EXPECT_EQ(figures.lost_contacts, 0u);
  EXPECT_EQ(figures.current_at_exit, 0);
  EXPECT_GT(figures.wire.reports, 1000u);
  EXPECT_FALSE(figures.paging);
  const std::atomic<bool> stop{true};
  const auto stopped = open("box");
  stopped->run(stop);
  EXPECT_EQ(stopped->figures().end, driver::ServoEnd::kStopped);
}

TEST_F(SessionTest, KnobsOfASessionWithoutThemNameTheOption) {
  const auto turned = open("box")->turn_knob("box: stiffness", 100);
  ASSERT_FALSE(turned);
  EXPECT_NE(turned.error().message.find("SessionOptions::knobs"), std::string::npos)
      << turned.error().message;
}

TEST_F(SessionTest, ReturnsDentsAndMeshesByName) {
  session::SessionOptions options;
  options.duration = 3;
  const auto balloon = open("water_balloon", options);
  balloon->run();
  const auto dented = balloon->deepest_dent();
  ASSERT_TRUE(dented);
  EXPECT_GT(dented->triangles.size(), balloon->mesh_now().triangles.size());
  const auto box = open("box", options);
  box->run();
  EXPECT_FALSE(box->deepest_dent());
  const std::string name = box->scene().objects.front().name;
  ASSERT_TRUE(box->find_object(name));
  EXPECT_GT(box->mesh_now(*box->find_object(name)).vertices.size(), 0u);
  EXPECT_LT(box->mesh_now(*box->find_object(name)).vertices.size(),
            box->mesh_now().vertices.size());
  EXPECT_FALSE(box->find_object("no such object"));
}

TEST_F(SessionTest, RecordingReplaysBitIdentically) {
  const auto file = support::scratch_folder() / "session.h5";
  const auto session = open("rubber");
  for (int i = 0; i < 100; ++i) session->step();
  ASSERT_TRUE(session->begin_recording(file));
  while (!session->step()) {
  }
  const auto ended = session->end_recording();
  ASSERT_TRUE(ended);
  ASSERT_TRUE(*ended);
  EXPECT_EQ(**ended, file);
  EXPECT_FALSE(*session->end_recording()) << "there is none any more";
  auto recording = session::read_recording(file);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(recording->complete);
  EXPECT_EQ(recording->ticks.size(), session->ticks().size() - 100);
  EXPECT_FALSE(session::check_repeatable(*recording)) << "it begins in the middle";

  const auto whole_file = support::scratch_folder() / "whole.h5";
  session::SessionOptions options;
  options.record = whole_file;
  const auto again = open("rubber", options);
  again->run();
  ASSERT_TRUE(again->end_recording());
  auto whole = session::read_recording(whole_file);
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_TRUE(session::check_repeatable(*whole));
  const auto same = session::replay(*whole);
  ASSERT_TRUE(same) << same.error().message;
  EXPECT_EQ(same->compared.ticks, whole->ticks.size());
  EXPECT_EQ(same->compared.differing, 0u);
  EXPECT_EQ(same->felt.ticks.size(), whole->ticks.size());
  const auto other = session::replay(*whole, "honey");
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(other->felt.info.scene, "honey");
  EXPECT_GT(other->compared.differing, 0u);
  EXPECT_FALSE(session::check_repeatable(*whole, "honey"));
  whole->ticks.erase(whole->ticks.begin() + 10);
  EXPECT_FALSE(session::check_repeatable(*whole)) << "a tick is missing";
}

struct PreparedLaw {
  mutable std::uint64_t prepared = 0;
  driver::ForceCommand operator()(const driver::DeviceState&) noexcept { return {}; }
  void prepare(const driver::DeviceState&) const noexcept { ++prepared; }
};

TEST_F(SessionTest, LawPreparesTicksOnlyInRealTime) {
  PreparedLaw law;
  session::SessionOptions options;
  options.duration = 0.2;
  const auto run = [&] {
    const auto session = open("box", options);
    ASSERT_TRUE(session->set_servo_law(driver::ForceLaw(law)));
    session->run();
  };
  run();
  EXPECT_EQ(law.prepared, 0u);
  options.clock = session::ClockKind::kWall;
  // On a busy machine every tick of a run may be late, so that no time remains to prepare.
  for (int tries = 0; law.prepared == 0 && tries < 100; ++tries) run();
  EXPECT_GT(law.prepared, 0u);
}

TEST_F(SessionTest, RunsInRealTimeOnASeparateThread) {
  session::SessionOptions options;
  options.clock = session::ClockKind::kWall;
  options.duration = 0.2;
  const auto session = open("box", options);
  const std::atomic<bool> stop{false};
  session::ServoThread servo(false);
  servo.begin(*session, stop);
  servo.join();
  EXPECT_TRUE(session->real_time());
  EXPECT_GT(session->figures(servo.grant()).statistics.ticks(), 0u);
}

}  // namespace
}  // namespace thimble
