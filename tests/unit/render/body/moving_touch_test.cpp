#include "body/motion/moving_touch.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "body/motion/body_motions.h"
#include "body/motion/move_object.h"
#include "support/hard_case.h"
#include "support/heap_guard.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/stylus.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/effect/map_settings.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;
const double kNaN = std::numeric_limits<double>::quiet_NaN();

SurfaceChoice surface_of(double stiffness, double damping, bool friction = false) {
  SurfaceChoice surface{.spring = {.stiffness = stiffness, .damping = damping}};
  for (const EffectKind& kind : effect_table()) {
    if (!friction || kind.name != "bristle") continue;
    MapSettings settings({{"coefficient", 0.6}, {"stiffness", stiffness}});
    surface.effects.push_back({&kind, kind.read(settings, {})});
  }
  return surface;
}

std::unique_ptr<ObjectTouch> moving(const TriangleMesh& mesh, const MotionChoice& motion,
                                    double stiffness, double damping, bool friction = false) {
  const SurfaceChoice surface = surface_of(stiffness, damping, friction);
  auto touch = build_object_touch(mesh, {}, surface);
  auto moved = move_object(std::move(touch).value(), mesh, motion, {stiffness, damping, kTick});
  EXPECT_TRUE(moved) << (moved ? "" : moved.error().message);
  return std::move(moved).value();
}

const RigidBody& rigid(const ObjectTouch& object) {
  return dynamic_cast<const MovingTouch<RigidMotion>&>(object).motion().body();
}

// A block of 60 x 40 x 20 mm.
TriangleMesh block() {
  return support::box({0.03, 0.02, 0.01});
}

// Motion that records its pushes and does not move.
struct Spy {
  std::vector<std::pair<Vector3d, Vector3d>>* pushes;
  double gain = 0;
  Eigen::Matrix3d R_WB() const noexcept {
    return Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  }
  Vector3d p_WB() const noexcept { return {0.01, 0.02, -0.03}; }
  BodyFrame frame_after(double) const noexcept { return {.R_WB = R_WB(), .p_WB = p_WB()}; }
  Vector3d velocity_at(const Vector3d&) const noexcept { return {0, 0, 0}; }
  Vector3d gain_at(const Vector3d&, const Vector3d& impulse) const noexcept {
    return gain * impulse;
  }
  void push(const Vector3d& f, const Vector3d& p) noexcept { pushes->emplace_back(f, p); }
  double energy() const noexcept { return 0; }
  void step(double) noexcept {}
};

TEST(MovingTouch, BodyGetsTheOppositeForce) {
  std::vector<std::pair<Vector3d, Vector3d>> pushes;
  auto touch = build_object_touch(support::icosphere(2, 0.03), {}, surface_of(500, 1, true));
  MovingTouch<Spy> moving(std::move(touch).value(), Spy{&pushes, 20}, {500, 1, kTick});
  support::Random random(1);
  driver::DeviceState state;
  state.dt = kTick;
  int felt = 0;
  for (int i = 0; i < 2000; ++i) {
    state.p_WT = Spy{}.p_WB() + random.uniform(0.027, 0.031) * random.direction();
    state.v_WT = random.in_box(0.1);
    pushes.clear();
    const Vector3d f = moving.update(state).f_T_W;
    if (f.norm() == 0) {
      EXPECT_TRUE(pushes.empty());
      continue;
    }
    ++felt;
    ASSERT_EQ(pushes.size(), 1u);
    EXPECT_EQ(pushes[0].first, -f);
    EXPECT_EQ(pushes[0].second, state.p_WT);
  }
  EXPECT_GT(felt, 500);
}

TEST(MovingTouch, FixedBodyFeelsLikeTheObject) {
  std::vector<std::pair<Vector3d, Vector3d>> pushes;
  const TriangleMesh mesh = support::bumpy_sphere(3, 0.03, 0.2, 5);
  MovingTouch<Spy> moved(build_object_touch(mesh, {}, surface_of(500, 1, true)).value(),
                         Spy{&pushes, 0}, {500, 1, kTick});
  auto still = build_object_touch(mesh, {}, surface_of(500, 1, true)).value();
  const Spy frame{};
  driver::DeviceState in_W;
  in_W.dt = kTick;
  for (int i = 0; i < 3000; ++i) {
    driver::DeviceState in_B = in_W;
    in_B.p_WT = 0.029 * Vector3d(std::cos(i * 3e-3), std::sin(i * 3e-3), 0.5 * std::sin(i * 1e-2));
    in_B.v_WT = Vector3d(0.01, -0.02, 0.03);
    in_W.p_WT = frame.p_WB() + frame.R_WB() * in_B.p_WT;
    in_W.v_WT = frame.R_WB() * in_B.v_WT;
    const auto a = still->update(in_B);
    const auto b = moved.update(in_W);
    ASSERT_EQ(a.touch.in_contact, b.touch.in_contact);
    ASSERT_EQ(a.touch.feature, b.touch.feature);
    ASSERT_LT((frame.R_WB() * a.f_T_W - b.f_T_W).norm(), 1e-9);
    if (!a.touch.in_contact) continue;
    ASSERT_LT((frame.p_WB() + frame.R_WB() * a.touch.p_WP - b.touch.p_WP).norm(), 1e-12);
    ASSERT_LT((frame.R_WB() * a.touch.n_W - b.touch.n_W).norm(), 1e-12);
  }
}

// A stylus meets bodies of 1 g to 100 kg through contact and friction stages, at any stiffness that
// a scene may set, at the centre and away from it.
TEST(HardCaseRigidBody, TouchKeepsTheMomenta) {
  double worst = 0, gain = -1;
  for (const double mass : {1e-3, 1e-2, 0.1, 1.0, 100.0}) {
    for (const double stiffness : {50.0, 800.0, 5000.0}) {
      for (const double off : {0.0, 0.015}) {
        for (const MotionKind kind : {MotionKind::kTranslate, MotionKind::kRigid}) {
          const MotionChoice motion{.kind = kind, .mass = mass};
          // A sampled wall at rest is passive for b > K T / 2 [PHYSICS 1.2].
          const double damping = std::max(1.0, 0.6 * kTick * stiffness);
          auto object = moving(block(), motion, stiffness, damping, true);
          support::Stylus stylus;
          stylus.p_WT = {-0.035, off, off / 3};
          stylus.v_WT = {0.3, 0.05, 0};
          const double energy = stylus.energy();
          const Vector3d momentum = stylus.momentum();
          const Vector3d angular = stylus.angular_momentum();
          double most = 0;
          bool touched = false;
          for (int i = 0; i < 1000; ++i) {
            const auto felt = stylus.follow(*object);
            touched = touched || felt.touch.in_contact;
            ASSERT_TRUE(felt.f_T_W.allFinite());
            if (kind != MotionKind::kRigid) continue;
            const RigidBody& body = rigid(*object);
            most = std::max(most, body.kinetic_energy() + stylus.energy());
            const Vector3d sum = body.momentum_W() + stylus.momentum();
            ASSERT_LT((sum - momentum).norm(), 1e-9 * momentum.norm());
            worst = std::max(worst, (sum - momentum).norm() / momentum.norm());
            const Vector3d turn = body.angular_momentum_W() + body.p_WC().cross(body.momentum_W()) +
                                  stylus.angular_momentum();
            ASSERT_LT((turn - angular).norm(), 1e-9 * momentum.norm() * 0.03);
          }
          EXPECT_TRUE(touched);
          EXPECT_LE(most, energy * 1.0001) << mass << " " << stiffness << " " << off;
          gain = std::max(gain, most / energy - 1);
          EXPECT_LE(stylus.energy(), energy) << mass << " " << stiffness << " " << off;
          if (kind != MotionKind::kTranslate) continue;
          const auto& mover =
              dynamic_cast<const MovingTouch<TranslatingMotion>&>(*object).motion().body();
          EXPECT_LT((mover.momentum_W() + stylus.momentum() - momentum).norm(),
                    1e-9 * momentum.norm());
        }
      }
    }
  }
  support::record_hard_case(36, "through contact and friction, 1 g to 100 kg, 50 to 5000 N/m",
                            "<= error of the momentum", worst, 1e-6, "1");
  support::record_hard_case(36, "the same", "<= energy beyond the first", gain, 1e-9, "1");
}

// The same without any damping, held against a floor by a hand or not: springs by themselves do not
// start to oscillate, even at stiffnesses beyond any arm.
TEST(MovingTouch, RestingHandCausesNoOscillation) {
  for (const double mass : {1e-3, 1e-2, 1.0, 100.0}) {
    for (const double stiffness : {200.0, 2000.0, 5000.0}) {
      MotionChoice motion{.kind = MotionKind::kRigid, .mass = mass};
      motion.gravity_W = {0, 0, -9.81};
      motion.floor = Floor{.n_W = {0, 0, 1}, .height = -0.01, .friction = 0.5};
      auto object = moving(block(), motion, stiffness, 0, true);
      support::Stylus stylus{.hand_stiffness = 300, .hand_damping = 3};
      stylus.p_WT = {0.01, 0.005, 0.015};
      stylus.p_WH = {0.01, 0.005, 0.002};
      double deepest = 0, loudest = 0;
      for (int i = 0; i < 1500; ++i) {
        const auto felt = stylus.follow(*object);
        deepest = std::max(deepest, felt.touch.depth);
        if (i > 1000) loudest = std::max(loudest, stylus.v_WT.norm());
        ASSERT_LT(rigid(*object).kinetic_energy(), 0.05);
      }
      EXPECT_LT(deepest, 0.02) << mass << " " << stiffness;
      EXPECT_LT(loudest, 0.3) << mass << " " << stiffness;
    }
  }
}

TEST(MovingTouch, FastBodyCannotPassARestingTip) {
  // A plate of 1 mm moves or turns past a tip at rest: 2 to 9 mm per tick.
  const TriangleMesh plate = support::plate(0.06, 0.001, 6);
  support::Random random(28);
  for (const MotionKind kind : {MotionKind::kTranslate, MotionKind::kRigid}) {
    for (int phase = 0; phase < 300; ++phase) {
      MotionChoice motion{.kind = kind, .mass = 100};
      const bool turns = kind == MotionKind::kRigid && phase % 2 == 0;
      if (turns) {
        motion.omega_W = {0, random.uniform(60, 150), 0};  // at 25 mm: up to 3.7 m/s
      } else {
        motion.v_W = {0, 0, random.uniform(2, 9)};
      }
      auto object = moving(plate, motion, 800, 1);
      driver::DeviceState state;
      state.p_WT = turns ? Vector3d(-0.025, 0.0041, random.uniform(0.004, 0.008))
                         : Vector3d(0.0083, 0.0041, random.uniform(0.01, 0.02));
      state.dt = kTick;
      bool met = false;
      for (int i = 0; i < 40 && !met; ++i) met = object->update(state).touch.in_contact;
      ASSERT_TRUE(met) << phase << (turns ? " turning" : " running");
    }
  }
}

// [BP 4.3]: with time scale s a body feels like one of mass / s^2.
TEST(MovingTouch, FeelsHeavierByTheSquareOfTheTimeScale) {
  for (const double s : {0.25, 0.5, 2.0}) {
    for (const MotionKind kind : {MotionKind::kTranslate, MotionKind::kRigid}) {
      auto slow = moving(block(), {.kind = kind, .mass = 0.2, .time_scale = s}, 800, 1);
      auto heavy = moving(block(), {.kind = kind, .mass = 0.2 / (s * s)}, 800, 1);
      for (int i = 0; i < 400; ++i) {
        driver::DeviceState state;
        state.dt = kTick;
        state.p_WT = {-0.031 + 1e-5 * i, 0.006, 0.002};
        state.v_WT = {0.01, 0, 0};
        const Vector3d a = slow->update(state).f_T_W;
        const Vector3d b = heavy->update(state).f_T_W;
        ASSERT_LT((a - b).norm(), 1e-9 * (1 + b.norm())) << s << " " << i;
      }
    }
  }
}

TEST(MovingTouch, LeavingTheWorkspaceIsHarmless) {
  // Similar to hard case 37: a light block is pushed continuously. It stops at its reach, where the
  // hand feels a wall, and far away it has no force.
  for (const double mass : {1e-3, 0.1, 10.0}) {
    for (const MotionKind kind : {MotionKind::kTranslate, MotionKind::kRigid}) {
      auto object = moving(block(), {.kind = kind, .mass = mass, .reach = 0.05}, 800, 1);
      support::Stylus stylus{.hand_stiffness = 300, .hand_damping = 3};
      stylus.p_WT = {-0.04, 0.001, 0};
      double jump = 0;
      Vector3d before(0, 0, 0);
      for (int i = 0; i < 6000; ++i) {
        // To 1 m beyond the edge at 0.25 m/s.
        stylus.p_WH = {-0.04 + std::min(i * 2.5e-4, 1.0), 0, 0};
        const auto felt = stylus.follow(*object);
        ASSERT_TRUE(felt.f_T_W.allFinite());
        // No force exceeds the hand's pull, at most 300 N/m * 1 m.
        ASSERT_LT(felt.f_T_W.norm(), 400);
        jump = std::max(jump, (felt.f_T_W - before).norm());
        before = felt.f_T_W;
        const auto p = object->pose().p_WB;
        ASSERT_LT(Vector3d(p[0], p[1], p[2]).norm(), 0.2);
      }
      // No kick: the largest change in a tick is at most that of a wall at the tip's speed.
      EXPECT_LT(jump, 60) << mass;
    }
  }
}

TEST(HeldTouch, FeelsItsWeightAndSlipsOutOfReach) {
  for (const MotionKind kind : {MotionKind::kTranslate, MotionKind::kRigid}) {
    for (const double mass : {1e-3, 0.1, 0.15}) {
      MotionChoice motion{.kind = kind, .mass = mass, .damping = 0.1, .reach = 0.08};
      motion.angular_damping = 1e-4;
      motion.gravity_W = {0, 0, -9.81};
      motion.grip = Grip{};
      auto object = moving(block(), motion, 800, 1);
      support::Stylus stylus{.hand_stiffness = 300, .hand_damping = 5};
      stylus.p_WT = stylus.p_WH = {0, 0, 0.01};
      for (int i = 0; i < 4000; ++i) stylus.follow(*object);
      EXPECT_NEAR(stylus.follow(*object).f_T_W.z(), -9.81 * mass, 0.02 * 9.81 * mass) << mass;
      // Carried to the workspace's edge and beyond, up to 1 m.
      bool slipped = false;
      for (int i = 0; i < 6000; ++i) {
        stylus.p_WH.x() = std::min(i * 2.5e-4, 1.0);
        const auto felt = stylus.follow(*object);
        ASSERT_TRUE(felt.f_T_W.allFinite());
        ASSERT_LE(felt.f_T_W.norm(), Grip{}.force_max * (1 + 1e-12));
        slipped = slipped || (i > 1000 && felt.f_T_W.norm() == 0);
        const auto p = object->pose().p_WB;
        ASSERT_LT(Vector3d(p[0], p[1], p[2]).norm(), 0.2);
      }
      EXPECT_TRUE(slipped) << mass;
    }
  }
}

TEST(MovingTouch, ADensityGivesTheMassOfTheMatterInside) {
  const TriangleMesh mesh = support::box({0.01, 0.02, 0.03});
  for (const MotionKind kind : {MotionKind::kTranslate, MotionKind::kRigid}) {
    MotionChoice choice{.kind = kind, .mass = 7};
    choice.density = 1000;
    const double mass = 1000 * 0.02 * 0.04 * 0.06;
    EXPECT_NEAR(mass_of(mesh, choice).value(), mass, 1e-12);
    // A tip at rest, 1 mm inside of the block for a tick.
    auto surface = build_object_touch(mesh, {}, surface_of(500, 0)).value();
    auto object = move_object(std::move(surface), mesh, choice, {500, 0, kTick}).value();
    driver::DeviceState state;
    state.dt = kTick;
    state.p_WT = {0, 0, 0.031};
    object->update(state);
    state.p_WT = {0, 0, 0.029};
    const double f = object->update(state).f_T_W.z();
    EXPECT_GT(f, 0.4);
    object->update(state);
    const double fallen = object->pose().p_WB[2];
    EXPECT_NEAR(fallen, -1.5 * f * kTick * kTick / mass, 0.7 * f * kTick * kTick / mass);
    for (const double bad : {1e-3, 1e9, kNaN}) {
      choice.density = bad;
      EXPECT_FALSE(mass_of(mesh, choice)) << bad;
    }
  }
}

TEST(MovingTouch, RefusesOrSurvivesInvalidInput) {
  const MotionChoice good{.kind = MotionKind::kRigid, .mass = 0.1};
  const auto refused = [&](const MotionChoice& choice, const TriangleMesh& mesh) {
    auto touch = build_object_touch(block(), {}, surface_of(500, 1)).value();
    return !move_object(std::move(touch), mesh, choice, {500, 1, kTick});
  };
  EXPECT_FALSE(refused(good, block()));
  for (const double bad : {0.0, -1.0, kNaN, HUGE_VAL}) {
    MotionChoice choice = good;
    choice.mass = bad;
    EXPECT_TRUE(refused(choice, block())) << bad;
    choice = good;
    choice.time_scale = bad;
    EXPECT_TRUE(refused(choice, block())) << bad;
    if (bad == 0) continue;
    choice = good;
    choice.damping = bad;
    EXPECT_TRUE(refused(choice, block())) << bad;
    choice = good;
    choice.angular_damping = bad;
    EXPECT_TRUE(refused(choice, block())) << bad;
    if (bad > 0) continue;
    choice = good;
    choice.reach = bad;
    EXPECT_TRUE(refused(choice, block())) << bad;
  }
  MotionChoice choice = good;
  choice.gravity_W.x() = kNaN;
  EXPECT_TRUE(refused(choice, block()));
  choice = good;
  choice.omega_W.x() = kNaN;
  EXPECT_TRUE(refused(choice, block()));
  choice = good;
  choice.grip = Grip{.stiffness = 0};
  EXPECT_TRUE(refused(choice, block()));
  choice.grip = Grip{.force_max = kNaN};
  EXPECT_TRUE(refused(choice, block()));
  TriangleMesh open = block();
  for (Vector3d& p : open.vertices) p.z() = 0;
  EXPECT_TRUE(refused(good, open)) << "no volume";

  for (const MotionKind kind : {MotionKind::kTranslate, MotionKind::kRigid}) {
    auto object = moving(block(), {.kind = kind, .mass = 1e-3}, 1e12, 1);
    driver::DeviceState state;
    support::Random random(9);
    for (int i = 0; i < 2000; ++i) {
      state.p_WT = random.in_box(0.05);
      state.v_WT = random.in_box(10);
      if (i % 7 == 0) state.p_WT.x() = kNaN;
      if (i % 11 == 0) state.v_WT.y() = kNaN;
      if (i % 13 == 0) state.p_WT.z() = HUGE_VAL;
      const auto felt = object->update(state);
      ASSERT_TRUE(felt.f_T_W.allFinite());
      for (const double x : object->pose().p_WB) ASSERT_TRUE(std::isfinite(x));
      for (const double x : object->pose().q_WB) ASSERT_TRUE(std::isfinite(x));
    }
  }
}

TEST(MovingTouch, ReportsItsPoseAndMovesItsMesh) {
  MotionChoice motion{.kind = MotionKind::kRigid, .mass = 0.1};
  motion.v_W = {0.1, 0, 0};
  motion.omega_W = {0, 0, 1};
  auto object = moving(block(), motion, 500, 1);
  EXPECT_FALSE(object->is_static());
  for (int i = 0; i < 500; ++i) object->update({});
  const BodyPose pose = object->pose();
  EXPECT_NEAR(pose.p_WB[0], 0.05, 1e-12);
  EXPECT_NEAR(pose.q_WB[0], std::cos(0.25), 1e-9);
  EXPECT_NEAR(pose.q_WB[3], std::sin(0.25), 1e-9);
  std::vector<Vector3d> vertices = block().vertices;
  object->place_now(vertices);
  const Eigen::Quaterniond q(pose.q_WB[0], pose.q_WB[1], pose.q_WB[2], pose.q_WB[3]);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    EXPECT_LT((q * block().vertices[i] + Vector3d(0.05, 0, 0) - vertices[i]).norm(), 1e-12);
  }
  EXPECT_TRUE(object->inside({0.05, 0, 0}));
  EXPECT_FALSE(object->inside({-0.029, 0, 0}));
}

TEST(MovingTouch, RestsOnItsFloorWithoutAllocation) {
  for (const MotionKind kind : {MotionKind::kTranslate, MotionKind::kRigid}) {
    MotionChoice motion{.kind = kind, .mass = 0.1};
    motion.gravity_W = {0, 0, -9.81};
    motion.floor = Floor{.n_W = {0, 0, 1}, .height = -0.03, .friction = 0.5};
    auto object = moving(block(), motion, 500, 1, true);
    driver::DeviceState state;
    state.dt = kTick;
    EXPECT_EQ(support::heap_calls_of([&] {
                for (int i = 0; i < 1500; ++i) {
                  state.p_WT = {0.001, 0.002, -0.0095 + 1e-3 * std::sin(i * 0.01)};
                  object->update(state);
                }
              }),
              0);
    EXPECT_NEAR(object->pose().p_WB[2], -0.02, 2e-5);
    EXPECT_NEAR(object->pose().q_WB[0], 1, 1e-3);
  }
}

}  // namespace
}  // namespace thimble::render
