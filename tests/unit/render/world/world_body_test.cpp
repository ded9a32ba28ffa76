// Objects that give way, move or carry effects, as solids of a world.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "body/motion/move_object.h"
#include "support/box_union.h"
#include "support/heap_guard.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/scene_touch.h"
#include "world/contact_world.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::SolidBlock;

constexpr double kTick = 1e-3;
constexpr double kStiffness = 800;
constexpr ContactChoice kGodObject{.tracker = TrackerChoice::kGodObject};

using Objects = std::vector<std::unique_ptr<ObjectTouch>>;

/// Moves a tip through a scene, with its speed.
class Tip {
 public:
  explicit Tip(SceneTouch& scene) : scene_(scene) {}
  driver::ForceCommand at(const Vector3d& p) {
    state_.dt = kTick;
    state_.v_WT = state_.tick > 0 ? Vector3d((p - state_.p_WT) / kTick) : Vector3d::Zero();
    state_.p_WT = p;
    const driver::ForceCommand command = scene_(state_);
    ++state_.tick;
    return command;
  }

 private:
  SceneTouch& scene_;
  driver::DeviceState state_;
};

std::unique_ptr<ObjectTouch> block(const SolidBlock& block, const ContactChoice& choice = {},
                                   double damping = 0) {
  return build_object_touch(block.mesh(), choice,
                            {.spring = {.stiffness = block.stiffness, .damping = damping}})
      .value();
}

std::unique_ptr<ObjectTouch> moving(const SolidBlock& solid, const MotionChoice& motion,
                                    const ContactChoice& choice = kGodObject) {
  return move_object(block(solid, choice), solid.mesh(), motion,
                     {.stiffness = solid.stiffness, .step = kTick})
      .value();
}

/// A kind of object that is felt in the same way, whether or not another solid is far away.
struct Kind {
  std::string name;
  std::function<std::unique_ptr<ObjectTouch>()> build;
};

std::vector<Kind> kinds() {
  const TriangleMesh ball = support::icosphere(3, 0.02);
  const auto surface = [](double damping) {
    return SurfaceChoice{.spring = {.stiffness = kStiffness, .damping = damping}};
  };
  const auto still = [=](TrackerChoice tracker, bool smooth) {
    return [=] {
      ContactChoice choice{.tracker = tracker};
      if (smooth) choice.blending = BlendingChoice::kPhong;
      return build_object_touch(ball, choice, surface(1)).value();
    };
  };
  const auto shaped = [=](TrackerChoice tracker, const ShapeChoice& shape) {
    return [=] {
      SurfaceChoice choice = surface(0);
      choice.shape = shape;
      return build_object_touch(ball, {.tracker = tracker}, choice).value();
    };
  };
  const auto moved = [=](MotionKind kind) {
    return [=] {
      return move_object(build_object_touch(ball, {}, surface(1)).value(), ball,
                         {.kind = kind, .mass = 0.2, .damping = 0.5},
                         {.stiffness = kStiffness, .damping = 1, .step = kTick})
          .value();
    };
  };
  const ShapeChoice clay{.clay = ClayChoice{.yield_force = 0.5}};
  return {{"edge_planes", still(TrackerChoice::kEdgePlanes, false)},
          {"edge_planes_smooth", still(TrackerChoice::kEdgePlanes, true)},
          {"offset", still(TrackerChoice::kOffset, true)},
          {"god_object", still(TrackerChoice::kGodObject, false)},
          {"compact", still(TrackerChoice::kPacked, false)},
          {"clay", shaped(TrackerChoice::kEdgePlanes, clay)},
          {"clay_god_object", shaped(TrackerChoice::kGodObject, clay)},
          {"snap", shaped(TrackerChoice::kEdgePlanes, {.snap = SnapChoice{.radius = 0.01}})},
          {"dent",
           [=] {
             SurfaceChoice choice = surface(0);
             choice.dent = DentSettings{.pull = 0.5};
             return build_object_touch(ball, {}, choice).value();
           }},
          {"translating", moved(MotionKind::kTranslate)},
          {"rigid", moved(MotionKind::kRigid)}};
}

TEST(WorldBody, AFarSolidChangesNothing) {
  for (const Kind& kind : kinds()) {
    Objects alone, together;
    alone.push_back(kind.build());
    together.push_back(kind.build());
    together.push_back(block({.centre = {0, 0, 0.5}, .half = {0.01, 0.01, 0.01}}));
    SceneTouch one(std::move(alone)), two(std::move(together));
    ASSERT_NE(two.world(), nullptr) << kind.name;
    Tip tip_one(one), tip_two(two);
    double most = 0, largest = 0;
    for (int i = 0; i < 4000; ++i) {
      const double t = 1e-3 * i;
      const Vector3d way(std::sin(3 * t), std::cos(5 * t), std::sin(2 * t + 1));
      const Vector3d p = (0.0195 + 0.0025 * std::sin(9 * t + 1.5)) * way.normalized();
      const driver::ForceCommand a = tip_one.at(p), b = tip_two.at(p);
      most = std::max(most, (a.f_T_W - b.f_T_W).norm());
      largest = std::max(largest, a.f_T_W.norm());
      ASSERT_NEAR(a.stored, b.stored, 1e-9) << kind.name << ' ' << i;
      ASSERT_EQ(a.touch.in_contact, b.touch.in_contact) << kind.name << ' ' << i;
    }
    EXPECT_GT(largest, 0.2) << kind.name;
    EXPECT_LT(most, 1e-9) << kind.name;
  }
}

TEST(WorldBody, TheHandAndAMovingBodyKeepTheirMomentum) {
  // A movable block beside a wall, pressed into the corner between both.
  const SolidBlock solid{.centre = {0.015, 0, 0}, .half = {0.015, 0.02, 0.02}};
  Objects objects;
  objects.push_back(moving(solid, {.kind = MotionKind::kTranslate, .mass = 0.5}));
  objects.push_back(block({.centre = {-0.02, 0, -0.02}, .half = {0.0201, 0.04, 0.02}}, kGodObject));
  SceneTouch scene(std::move(objects));
  Tip tip(scene);
  double momentum = 0;
  double last = 0;
  double pushed = 0;
  for (int i = 0; i < 900; ++i) {
    const double x = -0.004 + 1e-5 * i;
    const double z = std::max(0.003 - 2e-5 * i, -0.002);
    const driver::ForceCommand command = tip.at({x, 0.001, z});
    const BodyPose pose = scene.object(0).pose();
    const double speed = (pose.p_WB[0] - last) / kTick;
    last = pose.p_WB[0];
    // The wall takes no part along x. The body moves by its mean speed.
    const double before = std::exchange(momentum, momentum - command.f_T_W.x() * kTick);
    ASSERT_NEAR((before + momentum) / 2, 0.5 * speed, 1e-9) << i;
    pushed = std::max(pushed, command.f_T_W.norm());
  }
  EXPECT_GT(pushed, 1);
  EXPECT_GT(last, 1e-3);
}

TEST(WorldBody, ABodyThatSweepsOverTheTipCarriesItToAWall) {
  const SolidBlock solid{.centre = {0.03, 0, 0}, .half = {0.01, 0.02, 0.02}};
  Objects objects;
  objects.push_back(moving(solid, {.mass = 5, .v_W = {-0.05, 0, 0}}));
  objects.push_back(block({.centre = {-0.02, 0, 0}, .half = {0.01, 0.04, 0.04}}, kGodObject));
  SceneTouch scene(std::move(objects));
  Tip tip(scene);
  // The tip is held at the middle between both.
  double least = 0;
  for (int i = 0; i < 600; ++i) {
    const driver::ForceCommand command = tip.at({0.001, 0.002, 0.003});
    least = std::min(least, command.f_T_W.x());
    ASSERT_TRUE(command.f_T_W.allFinite());
    const double face = 0.02 + scene.object(0).pose().p_WB[0];
    if (face < 0.0005 && face > -0.005) {
      EXPECT_LT(command.f_T_W.x(), 0) << i;
    }
    EXPECT_GT(scene.world()->proxy().x(), -0.01);
  }
  EXPECT_LT(least, -1);
}

TEST(WorldBody, AFastTurningBodyMeetsAFreeTipFromAnywhere) {
  // A cube comes from 20 mm away, with 2 mm per tick.
  support::Random random(std::uint64_t{21});
  for (int i = 0; i < 100; ++i) {
    const Vector3d from = random.direction();
    Objects objects;
    objects.push_back(
        moving({.centre = 0.02 * from, .half = {0.005, 0.005, 0.005}},
               {.kind = i % 2 == 0 ? MotionKind::kRigid : MotionKind::kTranslate,
                .mass = 10,
                .v_W = -2 * from,
                .omega_W = i % 2 == 0 ? Vector3d(20 * random.direction()) : Vector3d::Zero()}));
    objects.push_back(block({.centre = {0, 0, -0.1}, .half = {0.04, 0.04, 0.01}}, kGodObject));
    SceneTouch scene(std::move(objects));
    Tip tip(scene);
    int met = -1;
    for (int k = 0; k < 12 && met < 0; ++k) {
      if (tip.at({0, 0, 0}).touch.in_contact) met = k;
    }
    // The surface is 5 to 8.7 mm before the middle of the cube.
    EXPECT_GE(met, 5) << i;
    EXPECT_LE(met, 8) << i;
  }
}

TEST(WorldBody, AMovableBlockOnATableIsPushedBySide) {
  for (const TrackerChoice tracker : {TrackerChoice::kEdgePlanes, TrackerChoice::kGodObject}) {
    const SolidBlock solid{.centre = {0.015, 0, 0.0075}, .half = {0.015, 0.03, 0.0075}};
    Objects objects;
    objects.push_back(
        block({.centre = {0, 0, -0.01}, .half = {0.06, 0.03, 0.01}}, {.tracker = tracker}));
    objects.push_back(moving(solid, {.mass = 0.2, .damping = 3}, {.tracker = tracker}));
    SceneTouch scene(std::move(objects));
    Tip tip(scene);
    driver::ForceCommand last;
    for (int i = 0; i < 1500; ++i) {
      last =
          tip.at({-0.006 + 1e-5 * std::max(0, i - 400), 0.001, std::max(-0.002, 0.002 - 1e-5 * i)});
    }
    // Pushed along, with the force of its damping, and the table still felt.
    EXPECT_GT(scene.object(1).pose().p_WB[0], 0.003);
    EXPECT_LT(last.f_T_W.x(), -0.02);
    EXPECT_NEAR(last.f_T_W.z(), 0.002 * kStiffness, 0.01);
  }
}

TEST(WorldBody, TicksAllocateNothing) {
  for (const Kind& kind : kinds()) {
    Objects objects;
    objects.push_back(kind.build());
    objects.push_back(block({.centre = {0, 0, -0.02}, .half = {0.03, 0.03, 0.01}}));
    SceneTouch scene(std::move(objects));
    Tip tip(scene);
    const int calls = support::heap_calls_of([&] {
      for (int i = 0; i < 3000; ++i) {
        const double t = 1e-3 * i;
        tip.at({0.015 * std::cos(7 * t), 0.015 * std::sin(5 * t),
                -0.008 + 0.015 * std::sin(3 * t + 1.5)});
      }
    });
    EXPECT_EQ(calls, 0) << kind.name;
  }
}

}  // namespace
}  // namespace thimble::render
