// Friction, texture and moving bodies under a tip that is a ball, against a point that touches at
// the same place.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "body/motion/move_object.h"
#include "support/box_union.h"
#include "support/meshes/concave_solids.h"
#include "support/random.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/effect/map_settings.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::SolidBlock;

constexpr double kRadius = 0.003, kTick = 1e-3, kStiffness = 600;

/// Moves a tip at random and hands its states on.
class Wanderer {
 public:
  Wanderer(const Vector3d& start, std::uint64_t seed) : random_(seed), p_(start), target_(start) {}

  driver::DeviceState next(double low, double high, double half) {
    if (++tick_ % 150 == 0) {
      target_ = {random_.uniform(-half, half), random_.uniform(-half, half),
                 random_.uniform(low, high)};
    }
    // A damped spring pulls it.
    v_ += kTick * (400 * (target_ - p_) - 40 * v_);
    p_ += kTick * v_;
    driver::DeviceState state;
    state.p_WT = p_;
    state.v_WT = v_;
    state.tick = tick_;
    state.time_ns = static_cast<std::int64_t>(tick_) * 1'000'000;
    return state;
  }

 private:
  support::Random random_;
  Vector3d p_, v_{0, 0, 0}, target_;
  std::uint64_t tick_ = 0;
};

SurfaceChoice rough_surface() {
  SurfaceChoice surface{.spring = {.stiffness = kStiffness, .damping = 1}};
  EffectContext context;
  context.tick = kTick;
  for (const auto& [name, numbers] : std::map<std::string, std::map<std::string, double>>{
           {"bristle", {{"coefficient", 0.5}, {"stiffness", kStiffness}}}}) {
    for (const EffectKind& kind : effect_table()) {
      if (kind.name != name) continue;
      MapSettings settings(numbers);
      surface.effects.push_back({&kind, kind.read(settings, context)});
    }
  }
  EXPECT_EQ(surface.effects.size(), 1u);
  return surface;
}

/// A block with its top at z = 0.
SolidBlock block() {
  return {.centre = {0, 0, -0.02}, .half = {0.05, 0.05, 0.02}};
}

EntryFaceBox box_of(const SolidBlock& solid) {
  EntryFaceBox box;
  box.p_WO = solid.centre;
  box.half_sides = solid.half;
  return box;
}

TEST(BallEffects, FrictionOnAFaceIsThatOfAPoint) {
  const auto point = build_primitive_touch(box_of(block()), rough_surface());
  const auto shape = build_primitive_touch(box_of(block()), rough_surface(), kRadius);
  const auto mesh =
      build_object_touch(block().mesh(), {.tip_radius = kRadius}, rough_surface()).value();
  Wanderer hand({0, 0, 0.01}, 720);
  int touching = 0;
  double across = 0;
  for (int i = 0; i < 20'000; ++i) {
    const driver::DeviceState state = hand.next(-0.004, 0.003, 0.03);
    driver::DeviceState lifted = state;
    lifted.p_WT.z() += kRadius;
    const Vector3d f = point->update(state).f_T_W;
    ASSERT_LT((shape->update(lifted).f_T_W - f).norm(), 1e-9) << i;
    ASSERT_LT((mesh->update(lifted).f_T_W - f).norm(), 1e-9) << i;
    touching += f.z() > 0 ? 1 : 0;
    across = std::max(across, std::hypot(f.x(), f.y()));
  }
  EXPECT_GT(touching, 5000);
  EXPECT_GT(across, 0.3);
}

/// Moves two bodies of the same mass with the same hand, and expects the same forces.
void expect_moved_alike(std::unique_ptr<ObjectTouch> one, std::unique_ptr<ObjectTouch> other,
                        const TriangleMesh& mesh, const MotionChoice& motion, double size) {
  const BodyCoupling coupling{kStiffness, 1, kTick};
  const auto a = move_object(std::move(one), mesh, motion, coupling).value();
  const auto b = move_object(std::move(other), mesh, motion, coupling).value();
  Wanderer hand({0, 0, 2 * size}, 721);
  int touching = 0;
  for (int i = 0; i < 20'000; ++i) {
    const driver::DeviceState state = hand.next(-size, size, size);
    const driver::ForceCommand f = a->update(state), g = b->update(state);
    ASSERT_LT((f.f_T_W - g.f_T_W).norm(), 1e-6) << i;
    touching += f.touch.in_contact ? 1 : 0;
  }
  EXPECT_GT(touching, 500);
  const BodyPose at_a = a->pose(), at_b = b->pose();
  Vector3d moved;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(at_a.p_WB[k], at_b.p_WB[k], 1e-7);
    moved[static_cast<Eigen::Index>(k)] = at_a.p_WB[k];
  }
  EXPECT_GT(moved.norm(), 0.001);
}

TEST(BallEffects, AMovingSphereIsPushedLikeALargerOne) {
  const Sphere sphere{.radius = 0.015}, larger{.radius = 0.015 + kRadius};
  const SurfaceChoice plain{.spring = {.stiffness = kStiffness, .damping = 1}};
  expect_moved_alike(build_primitive_touch(sphere, plain, kRadius),
                     build_primitive_touch(larger, plain), support::icosphere(3, 0.015),
                     {.mass = 0.5, .damping = 60}, 0.03);
}

/// A block of triangles and one without, under the same ball.
TEST(BallEffects, AMovingMeshIsPushedLikeItsShape) {
  const SolidBlock solid{.half = {0.02, 0.015, 0.01}};
  const SurfaceChoice plain{.spring = {.stiffness = kStiffness, .damping = 1}};
  expect_moved_alike(build_primitive_touch(box_of(solid), plain, kRadius),
                     build_object_touch(solid.mesh(), {.tip_radius = kRadius}, plain).value(),
                     solid.mesh(), {.mass = 0.5, .damping = 60}, 0.03);
}

}  // namespace
}  // namespace thimble::render
