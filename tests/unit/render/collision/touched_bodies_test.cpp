// A tip on bodies that meet others: bodies pinched against a wall, and thrown at a tip before one,
// from 1 g to 10 kg, 100 N/m to 1e5 N/m and 250 Hz to 8 kHz, without dampers.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "collision/collide_objects.h"
#include "collision/collision_world.h"
#include "support/hard_case.h"
#include "support/meshes/shapes.h"
#include "thimble/render/build_object_touch.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kHalf = 0.02;  // m, of the cube's side

/// A cube at the origin before a wall below it, touched by one tip without a damper.
class CubeBeforeWall {
 public:
  CubeBeforeWall(const MotionChoice& motion, double stiffness, double rate, std::size_t every,
                 double gap, double restitution = 0)
      : tick_(1 / rate) {
    const TriangleMesh cube = support::box(Vector3d::Constant(kHalf));
    WedgeBox box;
    box.half_sides = Vector3d::Constant(kHalf);
    const Primitive shape = box;
    const Primitive wall = HalfSpace{.n_W = {0, 0, 1}, .p_WO = {0, 0, -kHalf - gap}};
    std::vector<CollidingObject> objects(2);
    objects[0].name = "wall";
    objects[0].solid = {nullptr, &wall};
    objects[0].collision.restitution = restitution;
    objects[1].name = "cube";
    objects[1].solid = {&cube, &shape};
    objects[1].motion = motion;
    objects[1].coupling = {stiffness, 0, tick_};
    objects[1].surfaces.push_back(
        build_object_touch(cube, {}, {.spring = {.stiffness = stiffness, .damping = 0}}).value());
    auto made = collide_objects(std::move(objects), {}, {.every = every}, 1);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    touch_ = std::move(made->touches[0][0]);
    bodies_ = std::move(made->bodies);
  }

  /// Advances a tick with the tip at a place; returns the force on it.
  Vector3d step(const Vector3d& tip) {
    driver::DeviceState state;
    state.dt = tick_;
    state.p_WT = tip;
    const auto command = touch_->update(state);
    stored_ = command.stored;
    return command.f_T_W;
  }
  double speed(double mass) const { return bodies_->momentum_W().norm() / mass; }
  double height() const { return touch_->pose().p_WB[2]; }
  /// Returns the energy of motion, height and surface at the begin of the last tick, J.
  double stored() const { return stored_; }

 private:
  double tick_;
  double stored_ = 0;
  std::unique_ptr<ObjectTouch> touch_;
  std::shared_ptr<SharedBody> bodies_;
};

MotionChoice cube_of(double mass) {
  return {.kind = MotionKind::kRigid, .mass = mass};
}

/// Returns the rates of the loop, Hz, with a step of the solver of at most 4 ms.
std::vector<double> rates(std::size_t every) {
  if (every > 1) return {1e3, 8e3};
  return {250, 1e3, 8e3};
}
constexpr double kMasses[] = {1e-3, 1e-2, 0.1, 1, 10};
constexpr double kStiffnesses[] = {100, 1e3, 1e4, 1e5};

TEST(HardCasePinchedBody, RestsBetweenATipAndAWall) {
  for (const std::size_t every : {1u, 4u}) {
    double loudest = 0;
    for (const double rate : rates(every)) {
      for (const double mass : kMasses) {
        for (const double stiffness : kStiffnesses) {
          CubeBeforeWall rig(cube_of(mass), stiffness, rate, every, 0);
          const double depth = std::min(2 / stiffness, 0.01);  // 2 N, or 1 N where it is soft
          const auto ticks = static_cast<int>(2 * rate);
          double least = 1e9, most = 0;
          for (int i = 0; i < ticks; ++i) {
            const double in = depth * std::min(1.0, 10.0 * i / ticks);
            const Vector3d f = rig.step({0.004, -0.003, kHalf - in});
            ASSERT_TRUE(f.allFinite());
            if (i < ticks / 2) continue;
            least = std::min(least, f.z());
            most = std::max(most, f.z());
          }
          EXPECT_GT(least, 0) << every << " " << rate << " " << mass << " " << stiffness;
          EXPECT_NEAR(rig.height(), 0, 1e-4)
              << every << " " << rate << " " << mass << " " << stiffness;
          loudest = std::max(loudest, most - least);
        }
      }
    }
    EXPECT_LT(loudest, 0.005) << every;
    support::record_hard_case(43,
                              "bodies of 1 g to 10 kg pinched between tip and wall, undamped, a "
                              "step of collisions every " +
                                  std::to_string(every) + " ticks",
                              "<= change of force in the second second", loudest, 0.005, "N");
  }
}

TEST(HardCasePinchedBody, ATipRestsOnAStackOfTen) {
  constexpr double kStep = 1e-3, kStiffness = 600;
  const TriangleMesh cube = support::box(Vector3d::Constant(kHalf));
  std::vector<TriangleMesh> meshes;
  std::vector<Primitive> shapes;
  for (int i = 0; i < 10; ++i) {
    WedgeBox box;
    box.half_sides = Vector3d::Constant(kHalf);
    box.p_WO = {0, 0, (2 * i + 1) * kHalf};
    shapes.emplace_back(box);
    meshes.push_back(cube);
    for (Vector3d& p : meshes.back().vertices) p += box.p_WO;
  }
  std::vector<CollidingObject> objects(shapes.size());
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    objects[i].name = "block";
    objects[i].solid = {&meshes[i], &shapes[i]};
    objects[i].motion = cube_of(0.05);
    objects[i].motion->gravity_W = {0, 0, -9.81};
    objects[i].motion->floor = Floor{.n_W = {0, 0, 1}, .height = 0, .friction = 0.5};
    objects[i].coupling = {kStiffness, 0, kStep};
    objects[i].surfaces.push_back(
        build_object_touch(meshes[i], {}, {.spring = {.stiffness = kStiffness, .damping = 0}})
            .value());
  }
  auto made = collide_objects(std::move(objects), {}, {}, 1);
  ASSERT_TRUE(made) << (made ? "" : made.error().message);
  double least = 1e9, most = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    driver::DeviceState state;
    state.dt = kStep;
    state.p_WT = {0.004, -0.003, 20 * kHalf + 0.001 - 0.002 * std::min(1.0, tick / 500.0)};
    Vector3d f(0, 0, 0);
    for (auto& touch : made->touches) f += touch[0]->update(state).f_T_W;
    if (tick < 1500) continue;
    least = std::min(least, f.z());
    most = std::max(most, f.z());
  }
  EXPECT_GT(least, 0.4);
  EXPECT_LT(most - least, 0.005);
  support::record_hard_case(43, "a tip on a stack of ten blocks of 50 g",
                            "<= change of force in 1.5 s", most - least, 0.005, "N");
}

TEST(HardCasePinchedBody, ThrownBetweenTipAndWallGainsNoSpeed) {
  for (const std::size_t every : {1u, 4u}) {
    double fastest = 0;
    for (const double rate : rates(every)) {
      for (const double mass : kMasses) {
        for (const double stiffness : kStiffnesses) {
          const double speed = std::min({0.5, 0.005 * std::sqrt(stiffness / mass), 0.002 * rate});
          MotionChoice motion = cube_of(mass);
          motion.v_W = {0, 0, speed};
          CubeBeforeWall rig(motion, stiffness, rate, every, 0.003, 1);
          const auto ticks = static_cast<int>(4 * rate);
          int rebounds = 0;
          double before = speed;
          for (int i = 0; i < ticks; ++i) {
            ASSERT_TRUE(rig.step({0.004, -0.003, kHalf + 0.002}).allFinite());
            const double now = rig.speed(mass);
            fastest = std::max(fastest, now / speed);
            if (before > 0.1 * speed && now < 0.1 * speed) ++rebounds;
            before = now;
            ASSERT_GT(rig.height(), -0.0035) << rate << " " << mass << " " << stiffness;
          }
        }
      }
    }
    EXPECT_LE(fastest, 1 + 1e-6) << every;
    support::record_hard_case(43,
                              "bodies of 1 g to 10 kg thrown between tip and wall, undamped, a "
                              "step of collisions every " +
                                  std::to_string(every) + " ticks",
                              "<= largest speed over the first", fastest, 1 + 1e-6, "1");
  }
}

}  // namespace
}  // namespace thimble::render
