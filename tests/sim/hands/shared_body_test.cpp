// Energy that a body in two hands stores for each hand, and its use by the energy stage of each
// hand's gate.

#include "body/motion/shared_body.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "body/motion/body_motions.h"
#include "body/motion/mass_properties.h"
#include "body/motion/move_object.h"
#include "support/explained_rig.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/build_object_touch.h"

namespace thimble::render::shared_body_test {
namespace {

using Eigen::Vector3d;
using support::explained_limits;
using support::explained_stage;
using support::ExplainedRig;

constexpr double kTick = ExplainedRig::kTick;

/// A bar of 0.15 kg and 120 mm along y.
TriangleMesh bar() {
  return support::box({0.01, 0.06, 0.01});
}

using Body = SharedBodyOf<RigidMotion>;

std::shared_ptr<Body> floating_bar(double damping) {
  auto mass = mass_properties(bar(), 0.15);
  EXPECT_TRUE(mass);
  auto body = RigidBody::build(
      {.mass = *mass, .damping = damping, .angular_damping = 1e-3 * damping, .support_B = {}});
  EXPECT_TRUE(body);
  return std::make_shared<Body>(RigidMotion(*body, 1));
}

/// Two hands that push a body at random, each for some ticks in the same direction, and the work of
/// each.
struct Pushes {
  explicit Pushes(double damping) : body(floating_bar(damping)), hands{{{body, 2}, {body, 2}}} {}

  void tick(const std::array<Vector3d, 2>& f_W) {
    const auto p_W = ends();
    for (std::size_t i = 0; i < 2; ++i) hands[i].push(f_W[i], p_W[i]);
    body->step(kTick);
    const auto after_W = ends();
    for (std::size_t i = 0; i < 2; ++i) work[i] += f_W[i].dot(after_W[i] - p_W[i]);
  }
  std::array<Vector3d, 2> ends() const {
    const RigidBody& rigid = body->motion().body();
    return {rigid.moved({0, -0.05, 0}), rigid.moved({0, 0.05, 0})};
  }

  std::shared_ptr<Body> body;
  std::array<SharedMotion<RigidMotion>, 2> hands;
  std::array<double, 2> work{};
};

TEST(SharedBody, StoresEnergySeparatelyForEachHand) {
  Pushes pushes(0);
  support::Random random(1);
  std::array<double, 2> flow{};  // J, sum of the work in and out
  std::array<Vector3d, 2> f_W;
  for (int k = 0; k < 20'000; ++k) {
    if (k % 20 == 0) f_W = {random.in_box(0.1), random.in_box(0.1)};
    const std::array<double, 2> before = pushes.work;
    pushes.tick(f_W);
    for (std::size_t i = 0; i < 2; ++i) {
      flow[i] += std::abs(pushes.work[i] - before[i]);
      // The test uses the chord of each displacement, the body the tangents at its ends.
      ASSERT_NEAR(pushes.hands[i].energy(), pushes.work[i], 1e-2 * flow[i] + 1e-6) << k;
    }
  }
  EXPECT_GT(flow[0], 1e-3);
}

TEST(SharedBody, StoredPartsSumToItsEnergy) {
  Pushes pushes(0);
  support::Random random(2);
  for (int k = 0; k < 5'000; ++k) {
    pushes.tick({random.in_box(0.1), random.in_box(0.1)});
    const double energy = pushes.body->motion().energy();
    ASSERT_NEAR(pushes.hands[0].energy() + pushes.hands[1].energy(), energy, 1e-3 * energy + 1e-8);
  }
}

TEST(SharedBody, LossesAreNoCreditForAHand) {
  // One hand drags the body through a thick liquid; the other holds it without force.
  Pushes pushes(5);
  const double before = pushes.hands[1].energy();
  double least = before;
  for (int k = 0; k < 2'000; ++k) {
    const double force = k < 1'000 ? 1 : -1;
    pushes.tick({Vector3d(0, force, 0), Vector3d(0, 0, 0)});
    least = std::min(least, pushes.hands[1].energy());
  }
  EXPECT_GT(pushes.work[0], 0.2);
  EXPECT_GT(least, before - 1e-6);
}

TEST(SharedBody, WorkOfOneHandReducesTheOthersEnergy) {
  // The body is at rest: the energy from one hand goes to the other in the same tick.
  Pushes pushes(0);
  for (int k = 0; k < 50; ++k) pushes.tick({Vector3d(0, 1, 0), Vector3d(0, 0, 0)});
  const double energy = pushes.body->motion().energy();
  const double first = pushes.hands[0].energy(), second = pushes.hands[1].energy();
  for (int k = 0; k < 50; ++k) pushes.tick({Vector3d(0, 1, 0), Vector3d(0, -1, 0)});
  EXPECT_NEAR(pushes.body->motion().energy(), energy, 1e-12);
  EXPECT_NEAR(pushes.hands[0].energy() - first, pushes.work[0] - first, 1e-9);
  EXPECT_LT(pushes.hands[1].energy(), second - 0.015);
}

/// A bar that two hands hold, each through a gate with an energy account.
class Held {
 public:
  /// Takes the damping of the body, N s/m.
  explicit Held(double damping) {
    MotionChoice choice{.kind = MotionKind::kRigid, .mass = 0.15};
    choice.damping = damping;
    choice.grip = Grip{.stiffness = 400, .damping = 3, .force_max = 100};
    const SurfaceChoice surface{.spring = {.stiffness = 700, .damping = 2}};
    std::vector<std::unique_ptr<ObjectTouch>> surfaces;
    for (int i = 0; i < 2; ++i) {
      surfaces.push_back(std::move(build_object_touch(bar(), {}, surface)).value());
    }
    auto shared = move_shared_object(std::move(surfaces), bar(), choice, {700, 2, kTick});
    EXPECT_TRUE(shared);
    object_ = std::move(shared).value();
    for (std::size_t i = 0; i < 2; ++i) rigs_[i].open(kGrip[i]);
  }

  /// Runs a tick with the hands at their grips on the bar, moved by `move_W` (m). `extra_W`: a
  /// force that the law of the second hand adds, N.
  void tick(const std::array<Vector3d, 2>& move_W, const Vector3d& extra_W = {0, 0, 0}) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector3d p_W = kGrip[i] + move_W[i];
      driver::DeviceState state;
      state.p_WT = p_W;
      state.v_WT = begun_ ? Vector3d((p_W - p_W_[i]) / kTick) : Vector3d(0, 0, 0);
      driver::ForceCommand command = object_.touches[i]->update(state);
      if (i == 1) command.f_T_W += extra_W;
      changed += rigs_[i].tick(p_W, command) == command.f_T_W ? 0 : 1;
      largest = std::max(largest, command.f_T_W.norm());
      p_W_[i] = p_W;
    }
    begun_ = true;
    object_.body->step(kTick);
  }

  const ExplainedRig& rig(std::size_t hand) const { return rigs_[hand]; }
  /// Returns the work on both hands plus the energy that their own damping dissipated, J.
  double given() const {
    return rigs_[0].work() + rigs_[1].work() - rigs_[0].dissipated() - rigs_[1].dissipated();
  }

  int changed = 0;     // number of forces that a gate changed
  double largest = 0;  // N

 private:
  static inline const std::array<Vector3d, 2> kGrip{{{0, -0.045, 0}, {0, 0.045, 0}}};

  SharedObject object_;
  std::array<ExplainedRig, 2> rigs_{
      {{explained_limits(), explained_stage()}, {explained_limits(), explained_stage()}}};
  std::array<Vector3d, 2> p_W_;
  bool begun_ = false;
};

/// Returns positions of both hands on closed loops, the second one `phase` (rad) behind.
std::array<Vector3d, 2> loops(int tick, double frequency, double phase) {
  const auto at = [&](double angle) {
    return Vector3d(0.02 * std::sin(angle), 0.004 * (1 - std::cos(angle)),
                    0.015 * std::sin(2 * angle));
  };
  const double angle = 2 * std::numbers::pi * frequency * tick * kTick;
  return {at(angle), Vector3d(at(angle - phase) - at(-phase))};
}

TEST(SharedBody, HandsOnClosedLoopsLoseNoForce) {
  for (const double phase : {0.0, 0.5, 1.5, 3.1}) {
    Held held(0);
    for (int k = 0; k < 60'000; ++k) held.tick(loops(k, 1, phase));
    EXPECT_EQ(held.changed, 0) << phase;
    EXPECT_GT(held.largest, 0.1);
  }
}

TEST(SharedBody, HandsOnClosedLoopsWithLossesLoseNoForce) {
  Held held(0.5);
  for (int k = 0; k < 60'000; ++k) held.tick(loops(k, 1, 1.5));
  EXPECT_EQ(held.changed, 0);
}

TEST(SharedBody, HandsOnClosedLoopsGetNoTotalEnergy) {
  Held held(0);
  for (int k = 0; k < 60'000; ++k) held.tick(loops(k, 1, 1.5));
  // The hand's allowance, twice the onset, and its maximum saved credit.
  const driver::EnergyGuardSettings stage = explained_stage();
  EXPECT_LT(held.given(), 2 * (stage.reservoir + stage.allowance + 2 * stage.onset));
}

/// The first hand drags the bar back and forth through a thick liquid; the law of the second hand
/// pushes that hand in its direction of motion. Returns the work on the second hand, J.
double pushed_along(double damping) {
  Held held(damping);
  Vector3d last_W(0, 0, 0);
  for (int k = 0; k < 20'000; ++k) {
    const Vector3d move_W(0.02 * std::sin(4 * std::numbers::pi * k * kTick), 0, 0);
    const Vector3d way_W = move_W - last_W;
    last_W = move_W;
    held.tick({move_W, move_W}, 1.5 * way_W / std::max(way_W.norm(), 1e-9));
  }
  return held.rig(1).work() - held.rig(1).dissipated();
}

TEST(SharedBody, DragIsNoCreditForAWrongForce) {
  const driver::EnergyGuardSettings stage = explained_stage();
  const double tick = 2.5 * 0.26 * 2 * kTick;  // and the delay
  for (const double damping : {0.0, 5.0, 20.0}) {
    EXPECT_LT(pushed_along(damping), stage.reservoir + stage.allowance + 2 * stage.onset + tick)
        << damping;
  }
}

}  // namespace
}  // namespace thimble::render::shared_body_test
