#include "bringup/identify/cables/backlash/backlash_model.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "support/random.h"
#include "support/run_hash.h"

namespace thimble::bringup {
namespace {

using Gap = BacklashTheta;

constexpr std::size_t kGapFrom = 20, kGapTicks = 60;

/// Motors that are pushed back and forth, fast enough to cross their backlash and to stop.
ArmMotion shaken() {
  ArmMotion motion;
  motion.dt = 1e-3;
  for (std::size_t i = 0; i < kGapFrom + kGapTicks; ++i) {
    MotionSample sample;
    sample.fresh = true;
    sample.G = 7 * Eigen::Matrix3d::Identity();
    sample.G(0, 1) = 1.5;
    for (int k = 0; k < 3; ++k) {
      const auto joint = static_cast<std::size_t>(k);
      sample.tau[k] = i * (3 + joint) % 50 < 25 ? 0.3 : -0.3;
      sample.q[k] = 1e-5 * static_cast<double>((i + 20 * joint) % 100);
    }
    motion.samples.push_back(sample);
  }
  return motion;
}

Gap::Vector drawn(support::Random& random, bool rubs) {
  Gap::Vector theta = Gap::Vector::Zero();
  theta.segment<3>(Gap::kGain).setConstant(random.uniform(5, 15));
  theta[Gap::kDelay] = random.uniform(0, 5e-3);
  theta[Gap::kViscous] = random.uniform(0, 0.2);
  theta[Gap::kCoulomb] = random.uniform(0, 2);
  theta[Gap::kSpring] = random.uniform(0, 10);
  for (int k = 0; k < 3; ++k) {
    theta[Gap::kInertia + k] = random.uniform(1e-3, 1e-2);
    theta[Gap::kStiffness + k] = random.uniform(100, 2000);
    theta[Gap::kDamping + k] = random.uniform(0, 0.5);
    theta[Gap::kBacklash + k] = random.uniform(0, 1e-3);
    if (rubs) theta[Gap::kRotorCoulomb + k] = random.uniform(0, 2);
  }
  return theta;
}

using Angles = std::vector<double>;

TEST(BacklashModel, IsBitIdenticalInAnyLaneAndWithoutAvx2) {
  const ArmMotion motion = shaken();
  support::Random random(std::uint64_t{3});
  support::RunHash hash;
  for (const bool rubs : {false, true}) {
    std::array<Gap::Vector, kBacklashRunsAtOnce> theta;
    for (Gap::Vector& one : theta) one = drawn(random, rubs);
    std::array<BacklashState, kBacklashRunsAtOnce> together{}, alone{};
    std::array<Angles, kBacklashRunsAtOnce> angles;
    std::array<BacklashRun, kBacklashRunsAtOnce> runs;
    for (std::size_t i = 0; i < kBacklashRunsAtOnce; ++i) {
      angles[i].resize(3 * kGapTicks);
      runs[i] = {&theta[i], &together[i], angles[i].data()};
    }
    move_backlash_models(motion, {0, 0, 0}, runs, kGapFrom, kGapTicks);
    for (std::size_t i = 0; i < kBacklashRunsAtOnce; ++i) {
      Angles own(3 * kGapTicks);
      const BacklashRun run{&theta[i], &alone[i], own.data()};
      move_backlash_models(motion, {0, 0, 0}, {&run, 1}, kGapFrom, kGapTicks);
      EXPECT_EQ(alone[i].x, together[i].x) << i;
      EXPECT_EQ(own, angles[i]) << i;
      EXPECT_GT(std::abs(own.back()), 1e-4) << "it moves";
      for (const double angle : own) hash.add(angle);
    }
  }
  // Stored with AVX2; backlash_model_on_plain_lanes tests the code without it.
  EXPECT_EQ(hash.value(), 0xad7631cfb7704c2u);
}

/// Returns the exact motion of an axis of mass 1 under a constant force and dry friction.
std::pair<double, double> slid(double v, double a, double c, double t) {
  const double sliding = a - std::copysign(c, v), rest = -v / sliding;
  if (v != 0 && (rest <= 0 || rest > t)) return {v * t + 0.5 * sliding * t * t, v + sliding * t};
  const double x = v == 0 ? 0 : 0.5 * v * rest, left = v == 0 ? t : t - rest;
  if (std::abs(a) <= c) return {x, 0};
  const double on = a - std::copysign(c, a);
  return {x + 0.5 * on * left * left, on * left};
}

TEST(BacklashModel, TipSlidesLikeABodyWithDryFriction) {
  // Only the weight pulls on the tip: motors stay where they are, with slack cables.
  ArmMotion motion = shaken();
  for (MotionSample& sample : motion.samples) {
    sample.tau.setZero();
    sample.q.setZero();
  }
  Gap::Vector theta = Gap::Vector::Zero();
  theta.segment<3>(Gap::kInertia).setOnes();
  theta.segment<3>(Gap::kBacklash).setConstant(10);
  theta[Gap::kCoulomb] = 0.5;
  // The axis continues, stays, reverses or comes to rest, all in adjacent lanes.
  const std::array<std::pair<double, double>, kBacklashRunsAtOnce> cases = {
      {{0.02, 0.8}, {0, 0.4}, {-0.01, 2}, {0.02, -0.3}}};
  std::array<Gap::Vector, kBacklashRunsAtOnce> thetas;
  std::array<BacklashState, kBacklashRunsAtOnce> states{};
  std::array<BacklashRun, kBacklashRunsAtOnce> runs;
  for (std::size_t i = 0; i < kBacklashRunsAtOnce; ++i) {
    thetas[i] = theta;
    thetas[i][Gap::kWeight] = cases[i].second;
    states[i].v()[0] = cases[i].first;
    runs[i] = {&thetas[i], &states[i], nullptr};
  }
  move_backlash_models(motion, {0, 0, 0}, runs, kGapFrom, kGapTicks);
  for (std::size_t i = 0; i < kBacklashRunsAtOnce; ++i) {
    const auto [x, v] = slid(cases[i].first, cases[i].second, 0.5, kGapTicks * motion.dt);
    EXPECT_NEAR(states[i].p()[0], x, 1e-15) << i;
    EXPECT_NEAR(states[i].v()[0], v, 1e-13) << i;
  }
}

}  // namespace
}  // namespace thimble::bringup
