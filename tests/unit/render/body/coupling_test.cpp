// The coupling of tips and moving bodies creates no energy, with and without dampers.
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "body/motion/body_coupling.h"
#include "body/motion/body_motions.h"
#include "body/motion/move_object.h"
#include "body/motion/moving_touch.h"
#include "support/hard_case.h"
#include "support/meshes/shapes.h"
#include "support/physics.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/effect/map_settings.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::expect_physics;

constexpr double kGravity = 9.81;  // m/s^2

// Sides of 40 mm.
TriangleMesh cube() {
  return support::box({0.02, 0.02, 0.02});
}

SurfaceChoice surface_of(double stiffness, double damping, double friction_stiffness, double tick,
                         const char* friction = "bristle") {
  SurfaceChoice surface{.spring = {.stiffness = stiffness, .damping = damping}};
  if (!(friction_stiffness > 0)) return surface;
  for (const EffectKind& kind : effect_table()) {
    if (kind.name != friction) continue;
    std::map<std::string, double> numbers{{"coefficient", 0.6}, {"stiffness", friction_stiffness}};
    if (kind.name == "implicit_coulomb") numbers["damping"] = 0;
    MapSettings settings(numbers);
    EffectContext context;
    context.tick = tick;
    surface.effects.push_back({&kind, kind.read(settings, context)});
  }
  return surface;
}

// Several tips on one body, without dampers unless stated.
struct Tips {
  std::vector<std::unique_ptr<ObjectTouch>> touches;
  std::shared_ptr<SharedBody> body;
  double tick = 1e-3;

  Tips(const MotionChoice& motion, const SurfaceChoice& surface, double stiffness, double period,
       std::size_t count)
      : tick(period) {
    std::vector<std::unique_ptr<ObjectTouch>> surfaces;
    for (std::size_t i = 0; i < count; ++i) {
      surfaces.push_back(build_object_touch(cube(), {}, surface).value());
    }
    auto object = move_shared_object(std::move(surfaces), cube(), motion,
                                     {stiffness, surface.spring.damping, tick})
                      .value();
    touches = std::move(object.touches);
    body = std::move(object.body);
  }

  // Advances a tick with the tips at these places; returns the force on the first one.
  Vector3d step(const std::vector<Vector3d>& tips) {
    Vector3d first(0, 0, 0);
    touching = false;
    for (std::size_t i = 0; i < touches.size(); ++i) {
      driver::DeviceState state;
      state.dt = tick;
      state.p_WT = tips[i];
      const auto felt = touches[i]->update(state);
      touching = touching || felt.f_T_W.norm() > 0;
      if (i == 0) first = felt.f_T_W;
    }
    body->step(tick);
    return first;
  }
  Vector3d place() const {
    const auto p = touches[0]->pose().p_WB;
    return {p[0], p[1], p[2]};
  }
  // Energy of a cube of this mass.
  double energy(double mass) const {
    const double inertia = mass * 0.04 * 0.04 / 6;
    return body->momentum_W().squaredNorm() / (2 * mass) +
           body->angular_momentum_W().squaredNorm() / (2 * inertia);
  }
  bool touching = false;
};

// Roots of the step of a body of mass m on a resting tip, computed with the product's own
// functions.
struct StepMatrix {
  double determinant, trace;
};
StepMatrix step_matrix(double m, double k, double b, double h, double known_k, double known_b) {
  double a[2][2];
  for (int column = 0; column < 2; ++column) {
    // So small that no force exceeds the limit of a body.
    constexpr double kSmall = 1e-6;
    const double x = column == 0 ? kSmall : 0, v = column == 0 ? 0 : kSmall / h;
    TranslatingBody body(m, 0, 1, h);
    body.set_velocity({v, 0, 0});
    const TranslatingMotion motion(body, {.mass = m});
    const double ahead = x + motion.frame_after(h).p_WB.x();
    const double force =
        -(k * ahead + b * v) * shared_force({known_k, known_b, h}, Vector3d::UnitX(),
                                            motion.gain_at({0, 0, 0}, Vector3d::UnitX()));
    body.push({force, 0, 0});
    body.step();
    a[0][column] = (x + body.p_W().x()) / kSmall;
    a[1][column] = h * body.v_W().x() / kSmall;
  }
  return {a[0][0] * a[1][1] - a[0][1] * a[1][0], a[0][0] + a[1][1]};
}

TEST(BodyCoupling, StepOfABodyAtATipHasBothRootsInTheUnitCircle) {
  for (double m = 1e-4; m < 2e3; m *= 10) {
    for (double k = 1; k < 2e6; k *= 10) {
      for (const double b : {0.0, 1e-3, 0.1, 10.0, 1e3}) {
        for (double h = 1e-5; h < 0.2; h *= 10) {
          for (const double over : {1.0, 2.0, 50.0}) {  // the bounds may be above the true values
            const auto [det, trace] = step_matrix(m, k, b, h, over * k, over * b);
            const double stiff = k * h * h / m, damped = b * h / m;
            const double share = 1 / (1 + over * (stiff + damped));
            ASSERT_NEAR(det, 1 - share * (damped + stiff / 2), 1e-9);
            ASSERT_LE(det, 1 + 1e-12) << m << " " << k << " " << b << " " << h;
            ASSERT_GE(det, 0);
            ASSERT_LE(std::abs(trace), 1 + det + 1e-12) << m << " " << k << " " << b << " " << h;
          }
        }
      }
    }
  }
}

// Ratio of a body's speed after the impact on a tip at rest to its speed before.
double restitution(const MotionChoice& motion, const SurfaceChoice& surface, double stiffness,
                   double tick, double speed, double phase, std::size_t tips, double off) {
  MotionChoice thrown = motion;
  thrown.v_W = {0, 0, -speed};
  Tips rig(thrown, surface, stiffness, tick, tips);
  // Below the cube by a fraction of a tick's motion.
  const double below = -0.02 - speed * tick * (2 + phase);
  const std::vector<Vector3d> at{{0.001 + off, 0.002, below}, {-0.003 + off, 0.001, below}};
  const double before = rig.energy(motion.mass);
  const double patience = 100 + 8 * std::sqrt(motion.mass / stiffness) / tick;
  bool met = false;
  for (int i = 0; i < patience; ++i) {
    rig.step(at);
    met = met || rig.touching;
    if (met && !rig.touching) break;
  }
  EXPECT_TRUE(met) << motion.mass << " " << stiffness << " " << tick << " " << phase << " " << tips;
  EXPECT_FALSE(rig.touching) << motion.mass << " " << stiffness << " " << tick;
  return std::sqrt(rig.energy(motion.mass) / before);
}

TEST(HardCaseRestingBody, LeavesTipsNoFasterThanItCame) {
  std::map<std::string, double> worst;
  for (const double mass : {1e-3, 1e-2, 0.1, 1.0, 10.0}) {
    for (const double stiffness : {10.0, 100.0, 1e3, 1e4, 1e5}) {
      for (const double rate : {100.0, 1e3, 4e3, 2e4}) {
        const double speed = std::min({0.1, 0.005 * std::sqrt(stiffness / mass), 0.005 * rate});
        for (const double phase : {0.0, 0.3, 0.7, 0.999}) {
          for (const std::size_t tips : {std::size_t{1}, std::size_t{2}}) {
            const MotionChoice motion{.kind = MotionKind::kTranslate, .mass = mass};
            const SurfaceChoice plain = surface_of(stiffness, 0, 0, 1 / rate);
            const double back =
                restitution(motion, plain, stiffness, 1 / rate, speed, phase, tips, 0);
            double& most = worst[tips == 1 ? "one tip" : "two tips"];
            most = std::max(most, back);
          }
          if (phase > 0.5) continue;
          const MotionChoice turning{.kind = MotionKind::kRigid, .mass = mass};
          const SurfaceChoice rough = surface_of(stiffness, 0, stiffness, 1 / rate);
          double& most = worst["turning body with friction, off its centre"];
          most = std::max(most,
                          restitution(turning, rough, stiffness, 1 / rate, speed, phase, 1, 0.01));
        }
      }
    }
  }
  for (const auto& [what, value] : worst) {
    EXPECT_LE(value, 1 + 1e-9) << what;
    support::record_hard_case(42,
                              what + ", 1 g to 10 kg, 10 to 1e5 N/m, 100 Hz to 20 kHz, undamped",
                              "<= speed after over speed before", value, 1 + 1e-9, "1");
  }
}

TEST(HardCaseRestingBody, FallingBlockBouncesNoHigher) {
  double worst = 0;
  for (const double rate : {1e3, 8e3}) {
    for (const double stiffness : {200.0, 1000.0}) {
      for (const double mass : {0.005, 0.02, 0.1, 0.5}) {
        MotionChoice motion{.mass = mass};
        motion.gravity_W = {0, 0, -kGravity};
        auto object = move_object(
            build_object_touch(cube(), {}, surface_of(stiffness, 0, 0, 1 / rate)).value(), cube(),
            motion, {stiffness, 0, 1 / rate});
        driver::DeviceState state;
        state.dt = 1 / rate;
        state.p_WT = {0.003, 0.002, -0.025};
        double before = 0, last = 0, top = 0;
        for (int i = 0; i < 4 * rate; ++i) {
          (*object)->update(state);
          const double z = (*object)->pose().p_WB[2];
          if (before > last && before >= z && i > 2) {
            top = std::max(top, before);
          }
          last = before;
          before = z;
        }
        worst = std::max(worst, top);
      }
    }
  }
  EXPECT_LE(worst, 1e-9);
  support::record_hard_case(42, "blocks of 5 to 500 g from 5 mm on a resting tip, 4 s, undamped",
                            "<= rise above where they were let go", worst, 1e-9, "m");
}

TEST(HardCaseRestingBody, HeldBodySwingsNoFurther) {
  double worst = 0;
  for (const double rate : {100.0, 1e3, 8e3, 2e4}) {
    for (const double mass : {1e-3, 0.02, 0.1, 0.5}) {
      for (const MotionKind kind : {MotionKind::kTranslate, MotionKind::kRigid}) {
        MotionChoice motion{.kind = kind, .mass = mass};
        motion.gravity_W = {0, 0, -kGravity};
        motion.grip = Grip{.stiffness = 500, .damping = 0, .force_max = 50};
        auto object =
            move_object(build_object_touch(cube(), {}, surface_of(400, 0, 0, 1 / rate)).value(),
                        cube(), motion, {400, 0, 1 / rate});
        driver::DeviceState state;
        state.dt = 1 / rate;
        // Held off its middle, so that a body that can turn swings like a pendulum.
        state.p_WT = {0.004, 0, 0.01};
        double deepest = 0;
        for (int i = 0; i < 5 * rate; ++i) {
          (*object)->update(state);
          deepest = std::max(deepest, -(*object)->pose().p_WB[2]);
        }
        if (kind == MotionKind::kTranslate) {
          // The share softens the spring to k / (1 + k h^2 / m).
          worst = std::max(worst, deepest / (2 * kGravity * (mass / 500 + 1 / (rate * rate))));
        } else {
          // It can hang lower by the initial height of its middle above the tip, and no lower.
          EXPECT_LE(deepest, 0.03 + 3 * kGravity * (mass / 500 + 1 / (rate * rate)))
              << rate << " " << mass;
        }
      }
    }
  }
  EXPECT_LE(worst, 1 + 1e-9);
  support::record_hard_case(42,
                            "bodies of 1 to 500 g held by 500 N/m, let go, 5 s, 100 Hz to 20 kHz",
                            "<= deepest point over 2 m g / k'", worst, 1 + 1e-9, "1");
}

// Two fingers without dampers press a block and hold it against its weight by friction.
TEST(HardCaseRestingBody, PinchedBlockComesToRest) {
  double loudest = 0;
  for (const char* friction : {"bristle", "stiction_point", "lugre", "implicit_coulomb"}) {
    for (const MotionKind kind : {MotionKind::kTranslate, MotionKind::kRigid}) {
      for (const double hold : {300.0, 1000.0, 2000.0}) {
        for (const double mass : {0.02, 0.1}) {
          MotionChoice motion{.kind = kind, .mass = mass};
          motion.gravity_W = {0, 0, -kGravity};
          Tips rig(motion, surface_of(700, 0, hold, 1e-3, friction), std::max(700.0, hold), 1e-3,
                   2);
          double lowest = 0, highest = -1;
          for (int i = 0; i <= 4000; ++i) {
            // Fingers close within 20 ms, before the block has fallen by its size.
            const double in = 0.021 - 0.003 * std::min(1.0, i / 20.0);
            rig.step({{-in, 0, 0}, {in, 0, 0}});
            if (i == 3000) lowest = highest = rig.place().z();
            if (i > 3000) {
              lowest = std::min(lowest, rig.place().z());
              highest = std::max(highest, rig.place().z());
            }
          }
          EXPECT_GT(lowest, -0.02) << friction << " " << hold << " " << mass << " fell";
          loudest = std::max(loudest, highest - lowest);
        }
      }
    }
  }
  EXPECT_LE(loudest, 2e-4);
  support::record_hard_case(42, "blocks of 20 and 100 g between two fingers, 4 frictions, undamped",
                            "<= way in the fourth second", loudest * 1e3, 0.2, "mm");
}

// Closed forms. The step has first-order damping of its own, so these tests run at 20 kHz.
TEST(PhysicsOfCoupling, AHeldBodySwingsAtTheFrequencyOfItsSpring) {
  const double rate = 2e4, mass = 0.1;
  MotionChoice motion{.mass = mass};
  motion.gravity_W = {0, 0, -kGravity};
  motion.grip = Grip{.stiffness = 500, .damping = 0, .force_max = 50};
  auto object = move_object(build_object_touch(cube(), {}, surface_of(400, 0, 0, 1 / rate)).value(),
                            cube(), motion, {400, 0, 1 / rate});
  driver::DeviceState state;
  state.dt = 1 / rate;
  const double sag = mass * kGravity / 500;
  double before = 0, first = 0, last = 0;
  int crossings = 0;
  for (int i = 1; i <= 2 * rate; ++i) {
    (*object)->update(state);
    const double x = (*object)->pose().p_WB[2] + sag;
    if (before > 0 && x <= 0) {
      last = i - 1 + before / (before - x);
      if (crossings++ == 0) first = last;
    }
    before = x;
  }
  expect_physics({"held body", "frequency, 100 g held by 500 N/m, undamped", "sqrt(k / m) / (2 pi)",
                  "Hz", std::sqrt(500 / mass) / (2 * std::numbers::pi), 1e-3},
                 (crossings - 1) * rate / (last - first));
  motion.grip->damping = 2;
  auto damped = move_object(build_object_touch(cube(), {}, surface_of(400, 0, 0, 1 / rate)).value(),
                            cube(), motion, {400, 0, 1 / rate});
  double felt = 0;
  for (int i = 0; i < 3 * rate; ++i) felt = (*damped)->update(state).f_T_W.z();
  expect_physics({"held body", "weight felt of 100 g", "-m g", "N", -mass * kGravity, 1e-6}, felt);
  expect_physics({"held body", "sag of 100 g held by 500 N/m", "m g / k", "m", sag, 2e-3},
                 -(*damped)->pose().p_WB[2]);
}

TEST(PhysicsOfCoupling, ABlockReboundsFromATipAtItsSpeed) {
  const double rate = 2e4;
  const MotionChoice motion{.mass = 0.1};
  const double back =
      restitution(motion, surface_of(1000, 0, 0, 1 / rate), 1000, 1 / rate, 0.1, 0.5, 1, 0);
  // Loss of the step itself: a factor of 1 - k h^2 / (4 m) per tick, over half a period.
  expect_physics({"tip and body", "restitution of a block of 100 g at a tip, 1000 N/m, 20 kHz",
                  "1 (no damper)", "1", 1, 0.01},
                 back);
  const double zeta = 1 / (2 * std::sqrt(1000 * 0.1));
  const double damped =
      restitution(motion, surface_of(1000, 1, 0, 1 / rate), 1000, 1 / rate, 0.1, 0.5, 1, 0);
  // The spring-damper never pulls: contact ends when the force is zero [Schwager], at the phase of
  // the closed form.
  const double root = std::sqrt(1 - zeta * zeta);
  const double end = std::atan2(2 * zeta * root, 2 * zeta * zeta - 1);
  expect_physics({"tip and body", "the same with 1 N s/m",
                  "exp(-z / sqrt(1 - z^2) atan2(2 z sqrt(1 - z^2), 2 z^2 - 1))", "1",
                  std::exp(-zeta / root * end), 0.01},
                 damped);
}

}  // namespace
}  // namespace thimble::render
