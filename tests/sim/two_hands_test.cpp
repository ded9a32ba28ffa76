#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "body/motion/shared_body.h"
#include "setup.h"
#include "support/heap_guard.h"
#include "support/run_hash.h"
#include "support/scratch.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/recording.h"
#include "thimble/session/session.h"

// Several arms in one run, through the complete chain: one beam in two hands.

namespace thimble {
namespace {

using Eigen::Vector3d;

const std::filesystem::path kTwoHands =
    std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes/two_hands.yaml";
constexpr double kMass = 0.15, kGravity = 9.81, kPeriod = 1e-3;
const std::atomic<bool> kGoOn{false};

std::unique_ptr<session::Session> open_two_hands(
    const std::function<void(scene::Scene&)>& adjust = {}) {
  session::SessionOptions options;
  options.several_arms = true;
  options.adjust = adjust;
  auto opened = session::Session::open(kTwoHands, options);
  if (!opened) {
    ADD_FAILURE() << opened.error().message;
    return nullptr;
  }
  return std::move(opened).value();
}

/// Removes everything that acts on the beam except the hands and gravity.
void free_the_beam(scene::Scene& scene) {
  render::MotionChoice& motion = *scene.objects[0].body.motion;
  motion.floor.reset();
  motion.damping = motion.angular_damping = 0;
}

Vector3d force_on_hand(const session::Session& session, std::size_t arm) {
  const auto& f = session.ticks(arm).back().f_wanted_W;
  return {f[0], f[1], f[2]};
}

scene::HandWaypoint station(double time, const Vector3d& p_W) {
  scene::HandWaypoint waypoint;
  waypoint.time = time;
  waypoint.p_W = p_W;
  waypoint.stop = true;
  return waypoint;
}

const render::SharedBody& beam(const session::Session& session) {
  return *session.setup().objects().shared_bodies()[0];
}

double height_of_beam(const session::Session& session) {
  double sum = 0;
  const auto mesh = session.mesh_now();
  for (const Vector3d& p : mesh.vertices) sum += p.z();
  return sum / static_cast<double>(mesh.vertices.size());
}

std::uint64_t hash_of_hands(const session::Session& session) {
  support::RunHash hash;
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    for (const auto& row : session.ticks(arm)) hash.add(row);
  }
  for (const Vector3d& p : session.mesh_now().vertices) {
    for (const double x : p) hash.add(x);
  }
  return hash.value();
}

TEST(TwoHands, CompleteRepeatablyWithoutFaultsOrHeap) {
  std::uint64_t first = 0;
  for (int time = 0; time < 2; ++time) {
    const auto session = open_two_hands();
    ASSERT_TRUE(session);
    ASSERT_EQ(session->arms(), 2U);
    driver::ServoEnd end{};
    EXPECT_EQ(support::heap_calls_of([&] { end = session->run(kGoOn); }), 0);
    EXPECT_EQ(end, driver::ServoEnd::kDone);
    for (std::size_t arm = 0; arm < 2; ++arm) {
      const session::RunFigures figures = session->figures({}, arm);
      EXPECT_EQ(figures.end, driver::ServoEnd::kDone);
      EXPECT_EQ(figures.fault, driver::Fault::kNone);
      EXPECT_EQ(figures.statistics.ticks(), 8000U);
      EXPECT_EQ(figures.current_at_exit, 0);
      EXPECT_GT(figures.statistics.contact_time(), 7.9) << "the beam has not slipped out of a hand";
      EXPECT_GT(figures.statistics.force_max(), 0.5 * kMass * kGravity);
      EXPECT_LT(figures.statistics.force_max(), 4);
    }
    const std::uint64_t hash = hash_of_hands(*session);
    if (time == 0) first = hash;
    EXPECT_EQ(hash, first);
  }
}

// When the beam is lifted evenly, each hand carries half, and the two forces are mirror images.
TEST(TwoHands, BearHalfOfTheWeightEach) {
  const auto session = open_two_hands();
  ASSERT_TRUE(session);
  const double low = height_of_beam(*session);
  for (int tick = 0; tick < 1500; ++tick) ASSERT_FALSE(session->step(kGoOn));
  Vector3d left(0, 0, 0), right(0, 0, 0);
  constexpr int kMean = 20;
  for (int tick = 0; tick < kMean; ++tick) {
    ASSERT_FALSE(session->step(kGoOn));
    left += force_on_hand(*session, 0) / kMean;
    right += force_on_hand(*session, 1) / kMean;
  }
  EXPECT_GT(height_of_beam(*session), low + 0.04);
  const double half = kMass * kGravity / 2;
  EXPECT_NEAR(left.z(), -half, 0.1 * half);
  EXPECT_NEAR(right.z(), -half, 0.1 * half);
  EXPECT_NEAR(left.z(), right.z(), 0.05 * half);
  EXPECT_NEAR(left.y(), -right.y(), 0.05 * half);
}

// Newton's third law: in every tick the momentum of the beam changes by that from both hands and
// gravity.
TEST(TwoHands, KeepTheMomentumAccountOfTheBeam) {
  const auto session = open_two_hands(free_the_beam);
  ASSERT_TRUE(session);
  Vector3d given(0, 0, 0);
  double largest = 0, turned = 0;
  for (int tick = 0; tick < 6000; ++tick) {
    ASSERT_FALSE(session->step(kGoOn));
    given += kPeriod * (Vector3d(0, 0, -kMass * kGravity) - force_on_hand(*session, 0) -
                        force_on_hand(*session, 1));
    const Vector3d momentum = beam(*session).momentum_W();
    ASSERT_LT((momentum - given).norm(), 1e-12) << "in tick " << tick;
    largest = std::max(largest, momentum.norm());
    turned = std::max(turned, beam(*session).angular_momentum_W().norm());
  }
  EXPECT_GT(largest, 1e-3) << "kg m/s; without motion the account tests nothing";
  EXPECT_GT(turned, 1e-6) << "kg m^2/s";
}

// One hand pulls and the other is still: it gets the pull through the beam.
TEST(TwoHands, FeelEachOtherThroughTheBeam) {
  constexpr double kPull = 6e-3;  // m
  const auto pulled_by = [&](double way) {
    const auto session = open_two_hands([&](scene::Scene& scene) {
      free_the_beam(scene);
      scene.objects[0].body.motion->gravity_W.setZero();
      scene.arms.front().hand = {station(0, {0, -0.045, -0.03}),
                                 station(1, {0, -0.045 - way, -0.03}),
                                 station(2, {0, -0.045 - way, -0.03})};
      scene.arms[1].hand = {station(0, {0, 0.045, -0.03}), station(2, {0, 0.045, -0.03})};
    });
    Vector3d left(0, 0, 0), right(0, 0, 0);
    for (int tick = 0; tick < 2000; ++tick) {
      EXPECT_FALSE(session->step(kGoOn));
      if (tick < 1900) continue;
      left += force_on_hand(*session, 0) / 100;
      right += force_on_hand(*session, 1) / 100;
    }
    return std::pair(left, right);
  };
  const auto [left, right] = pulled_by(kPull);
  EXPECT_GT(left.y(), 0.2) << "N: the hand is pulled back";
  EXPECT_LT(right.y(), -0.2) << "N: towards the hand that pulls";
  EXPECT_NEAR(left.y(), -right.y(), 0.02 * left.y()) << "the beam is at rest";
  const auto [calm_left, calm_right] = pulled_by(0);
  EXPECT_LT(calm_left.norm() + calm_right.norm(), 0.05);
}

TEST(TwoHands, FaultStopsBothUnlessTheSceneSaysApart) {
  constexpr int kTick = 1600;
  for (const auto rule : {scene::FaultRule::kTogether, scene::FaultRule::kApart}) {
    const bool apart = rule == scene::FaultRule::kApart;
    SCOPED_TRACE(apart ? "apart" : "together");
    const auto session = open_two_hands([&](scene::Scene& scene) { scene.faults = rule; });
    ASSERT_TRUE(session);
    for (int tick = 0; tick < kTick; ++tick) ASSERT_FALSE(session->step(kGoOn));
    ASSERT_GT(session->device(0).f_sent_W().norm(), 0.3);
    ASSERT_GT(session->device(1).f_sent_W().norm(), 0.3);
    session->device(1).trip(driver::Fault::kOverSpeed);
    const auto end = session->step(kGoOn);
    EXPECT_TRUE(session->device(1).f_sent_W().isZero(0));
    EXPECT_EQ(session->device(1).fault(), driver::Fault::kOverSpeed);
    if (!apart) {
      EXPECT_EQ(end, driver::ServoEnd::kFault);
      EXPECT_TRUE(session->device(0).f_sent_W().isZero(0));
      EXPECT_EQ(session->device(0).fault(), driver::Fault::kOtherArm) << "the reason is reported";
      EXPECT_EQ(session->step(kGoOn), driver::ServoEnd::kFault) << "the run stays ended";
      EXPECT_EQ(session->figures({}, 0).current_at_exit, 0);
      EXPECT_EQ(session->figures({}, 0).end, driver::ServoEnd::kStopped);
      EXPECT_EQ(session->figures({}, 1).end, driver::ServoEnd::kFault);
      continue;
    }
    EXPECT_FALSE(end);
    double most = 0;
    for (int tick = 0; tick < 300; ++tick) {
      ASSERT_FALSE(session->step(kGoOn));
      EXPECT_TRUE(session->device(1).f_sent_W().isZero(0));
      EXPECT_TRUE(force_on_hand(*session, 1).isZero(0)) << "the arm exerts no force on the beam";
      most = std::max(most, -session->device(0).f_sent_W().z());
    }
    EXPECT_GT(most, 0.6 * kMass * kGravity) << "the other hand carries more than half";
    EXPECT_EQ(session->run(kGoOn), driver::ServoEnd::kDone);
    EXPECT_EQ(session->figures({}, 0).fault, driver::Fault::kNone);
    EXPECT_EQ(session->figures({}, 1).fault, driver::Fault::kOverSpeed);
  }
}

// A fault of the first arm, whose loop runs first in a tick, also affects the second.
TEST(TwoHands, FaultOfTheFirstArmEndsAllForces) {
  const auto session = open_two_hands();
  ASSERT_TRUE(session);
  for (int tick = 0; tick < 1600; ++tick) ASSERT_FALSE(session->step(kGoOn));
  session->device(0).trip(driver::Fault::kOverSpeed);
  EXPECT_EQ(session->step(kGoOn), driver::ServoEnd::kFault);
  EXPECT_TRUE(session->device(1).f_sent_W().isZero(0));
  EXPECT_EQ(session->simulation(1)->currents(), Vector3d::Zero());
}

// Callers that handle one arm only get an error, and so do requests that need a single arm.
/// Runs the scene with a recording of each arm, and reads the recordings; one arm may have a fault
/// during the run.
std::vector<session::Recording> recorded_hands(scene::FaultRule rule, int fault_at) {
  const std::filesystem::path file = support::scratch_folder() / "hands.h5";
  session::SessionOptions options;
  options.several_arms = true;
  options.record = file;
  options.overwrite = true;
  options.adjust = [rule](scene::Scene& scene) { scene.faults = rule; };
  auto opened = session::Session::open(kTwoHands, options);
  if (!opened) {
    ADD_FAILURE() << opened.error().message;
    return {};
  }
  session::Session& session = **opened;
  for (int tick = 0; tick < 4000; ++tick) {
    if (tick == fault_at) session.device(1).trip(driver::Fault::kOverSpeed);
    if (session.step(kGoOn)) break;
  }
  const auto ended = session.end_recording();
  EXPECT_TRUE(ended) << ended.error().message;
  std::vector<session::Recording> recordings;
  for (const char* name : {"left", "right"}) {
    auto read = session::read_recording(session::file_of_arm(file, name));
    EXPECT_TRUE(read) << read.error().message;
    if (!read) return {};
    EXPECT_EQ(read->info.arm_in_scene, name);
    recordings.push_back(std::move(read).value());
  }
  return recordings;
}

// Each arm has its own recording; their common replay is bit-identical to the run, including
// faults.
TEST(TwoHands, ReplayOfAllRecordingsIsBitIdentical) {
  for (const int fault_at : {-1, 1600}) {
    SCOPED_TRACE(fault_at);
    const auto recordings = recorded_hands(scene::FaultRule::kApart, fault_at);
    ASSERT_EQ(recordings.size(), 2u);
    EXPECT_EQ(recordings[0].ticks.size(), 4000u);
    const auto replays = session::replay_together(recordings);
    ASSERT_TRUE(replays) << replays.error().message;
    ASSERT_EQ(replays->size(), 2u);
    double most = 0;
    for (std::size_t arm = 0; arm < 2; ++arm) {
      EXPECT_EQ((*replays)[arm].compared.ticks, 4000u);
      EXPECT_EQ((*replays)[arm].compared.differing, 0u) << arm;
      for (const auto& tick : (*replays)[arm].felt.ticks)
        most = std::max(most, -tick.f_wanted_W[2]);
    }
    EXPECT_GT(most, 0.5 * kMass * kGravity) << "forces, not zeros, were compared";
  }
}

TEST(TwoHands, ReplayNeedsAllRecordingsOfARun) {
  auto recordings = recorded_hands(scene::FaultRule::kTogether, -1);
  ASSERT_EQ(recordings.size(), 2u);
  const auto refusal = [](const std::vector<session::Recording>& given) {
    const auto replays = session::replay_together(given);
    return replays ? std::string("replayed") : replays.error().message;
  };
  EXPECT_NE(refusal({recordings[0]}).find("the recording of the arm \"right\" is missing"),
            std::string::npos)
      << refusal({recordings[0]});
  EXPECT_NE(refusal({recordings[0], recordings[0]}).find("\"right\""), std::string::npos);
  EXPECT_EQ(refusal({recordings[1], recordings[0]}), "replayed") << "the order is arbitrary";
  recordings[1].ticks.pop_back();
  EXPECT_NE(refusal(recordings).find("not from one run"), std::string::npos);
  // A single recording cannot be replayed.
  EXPECT_FALSE(session::replay(recordings[0]));
}

TEST(TwoHands, CallersForOneArmGetAnError) {
  const auto refusal = [](const session::SessionOptions& options) {
    const auto opened = session::Session::open(kTwoHands, options);
    return opened ? std::string("opened") : opened.error().message;
  };
  session::SessionOptions options;
  EXPECT_NE(refusal(options).find("the scene has 2 arms, but this command supports one"),
            std::string::npos)
      << refusal(options);
  options.several_arms = true;
  EXPECT_EQ(refusal(options), "opened");
  session::SessionOptions other = options;
  other.hand_by_mouse = true;
  EXPECT_NE(refusal(other).find("--hand mouse supports one arm only"), std::string::npos);
  other = options;
  other.arm_file = "touch";
  EXPECT_NE(refusal(other).find("cannot replace them all"), std::string::npos);
  other = options;
  other.adjust = [](scene::Scene& scene) { scene.arms[1].hand[1].p_W = {0, 0.4, 0}; };
  EXPECT_NE(refusal(other).find("the arm \"right\": At "), std::string::npos) << refusal(other);
  other.adjust = [](scene::Scene& scene) { scene.objects[0].body.shape.clay.emplace(); };
  EXPECT_NE(refusal(other).find("by one arm only"), std::string::npos) << refusal(other);
}

TEST(TwoHands, ExistingRecordingLeavesAllFilesUnchanged) {
  const std::filesystem::path file = support::scratch_folder() / "kept.h5";
  session::SessionOptions options;
  options.several_arms = true;
  options.duration = 0.01;
  options.record = file;
  {
    const auto first = session::Session::open(kTwoHands, options);
    ASSERT_TRUE(first) << first.error().message;
    ASSERT_TRUE((*first)->end_recording());
  }
  ASSERT_TRUE(std::filesystem::remove(session::file_of_arm(file, "left")));
  EXPECT_FALSE(session::Session::open(kTwoHands, options));
  EXPECT_FALSE(std::filesystem::exists(session::file_of_arm(file, "left")));
  EXPECT_TRUE(session::read_recording(session::file_of_arm(file, "right")));
}

}  // namespace
}  // namespace thimble
