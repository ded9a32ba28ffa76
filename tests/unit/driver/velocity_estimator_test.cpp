#include "velocity_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace thimble::driver {
namespace {

constexpr double kSamplePeriod = 1e-3;

TEST(VelocityEstimator, IsTheBackwardDifferenceWithoutAPole) {
  VelocityEstimator estimator(0);
  EXPECT_EQ(estimator.update({1, 2, 3}, kSamplePeriod), Eigen::Vector3d(0, 0, 0));
  EXPECT_LT((estimator.update({1.001, 2, 2.998}, kSamplePeriod) - Eigen::Vector3d(1, 0, -2)).norm(),
            1e-12);
}

TEST(VelocityEstimator, SettlesWithTheTimeConstantOfItsPole) {
  constexpr double kCorner = 100;
  VelocityEstimator estimator(kCorner);
  estimator.update({0, 0, 0}, kSamplePeriod);
  for (int k = 1; k <= 20; ++k) {
    const Eigen::Vector3d v = estimator.update({0.2 * k * kSamplePeriod, 0, 0}, kSamplePeriod);
    const double expected =
        0.2 * (1 - std::exp(-2 * std::numbers::pi * kCorner * kSamplePeriod * k));
    EXPECT_NEAR(v.x(), expected, 1e-12) << "sample " << k;
  }
}

TEST(VelocityEstimator, KeepsItsEstimateWhenNoTimePasses) {
  VelocityEstimator estimator(0);
  estimator.update({0, 0, 0}, kSamplePeriod);
  estimator.update({1e-3, 0, 0}, kSamplePeriod);
  EXPECT_EQ(estimator.update({5, 5, 5}, 0), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(estimator.update({5, 5, 5}, -1), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(estimator.update({5, 5, 5}, NAN), Eigen::Vector3d(1, 0, 0));
}

TEST(VelocityEstimator, SpreadsOneEncoderStepOverTime) {
  // The noise of a damper B on an encoder of step s is B s / T without a pole, and `a` times this
  // value with one.
  constexpr double kStep = 30e-6;
  VelocityEstimator plain(0), smooth(30);
  for (auto* estimator : {&plain, &smooth}) estimator->update({0, 0, 0}, kSamplePeriod);
  const double a = 1 - std::exp(-2 * std::numbers::pi * 30 * kSamplePeriod);
  EXPECT_NEAR(plain.update({kStep, 0, 0}, kSamplePeriod).x(), kStep / kSamplePeriod, 1e-15);
  EXPECT_NEAR(smooth.update({kStep, 0, 0}, kSamplePeriod).x(), a * kStep / kSamplePeriod, 1e-15);
}

}  // namespace
}  // namespace thimble::driver
