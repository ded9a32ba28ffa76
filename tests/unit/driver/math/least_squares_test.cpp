#include "math/least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace thimble::math {
namespace {

using Eigen::Vector2d;

/// Fits y = a exp(b t) to exact samples of 2 exp(-3 t). Positive b is not allowed.
struct Decay {
  static constexpr int kSamples = 20;

  static double time(int i) { return 0.05 * i; }
  static double residual(const Vector2d& x, int i) {
    return x[0] * std::exp(x[1] * time(i)) - 2 * std::exp(-3 * time(i));
  }

  double linearize(const Vector2d& x, Eigen::Matrix2d& normal, Vector2d& gradient) const {
    normal.setZero();
    gradient.setZero();
    for (int i = 0; i < kSamples; ++i) {
      const double shape = std::exp(x[1] * time(i));
      const Vector2d row(shape, x[0] * time(i) * shape);
      normal += row * row.transpose();
      gradient += row * residual(x, i);
    }
    return sum(x);
  }
  Vector2d stepped(const Vector2d& x, const Vector2d& by) const { return x + by; }
  double sum(const Vector2d& x) const {
    if (x[1] > 0) return std::numeric_limits<double>::quiet_NaN();
    double squares = 0;
    for (int i = 0; i < kSamples; ++i) squares += residual(x, i) * residual(x, i);
    return squares;
  }
};

TEST(LevenbergMarquardt, FindsTheLeastSquaresFromAPoorStart) {
  Vector2d x(0.1, -0.1);
  const Decay problem;
  const double least = levenberg_marquardt<Eigen::Matrix2d>(problem, x, {.rounds = 100});
  EXPECT_LT(least, 1e-20);
  EXPECT_LT((x - Vector2d(2, -3)).norm(), 1e-9);
  EXPECT_DOUBLE_EQ(least, problem.sum(x));
}

TEST(LevenbergMarquardt, EachRoundChangesToASmallerSum) {
  const Decay problem;
  double before = problem.sum({0.1, -0.1});
  for (int rounds = 1; rounds <= 6; ++rounds) {
    Vector2d x(0.1, -0.1);
    levenberg_marquardt<Eigen::Matrix2d>(problem, x, {.rounds = rounds});
    EXPECT_LT(problem.sum(x), before) << rounds;
    before = problem.sum(x);
  }
}

TEST(LevenbergMarquardt, KeepsItsStartWithoutABetterStep) {
  Vector2d x(2, -3);
  levenberg_marquardt<Eigen::Matrix2d>(Decay(), x, {});
  EXPECT_EQ(x, Vector2d(2, -3));
}

TEST(ScaledNormal, SolvesEquationsOfVeryDifferentUnits) {
  Eigen::Matrix2d normal;
  normal << 4e12, 1e3, 1e3, 9e-6;
  const Vector2d x(1e-6, 2e3), right = normal * x;
  EXPECT_LT((ScaledNormal<Eigen::Matrix2d>(normal).solve(right) - x).cwiseQuotient(x).norm(), 1e-9);
  const Eigen::Matrix2d covariance = ScaledNormal<Eigen::Matrix2d>(normal).covariance();
  EXPECT_LT((covariance.cwiseQuotient(normal.inverse()).array() - 1).abs().maxCoeff(), 1e-9);
}

TEST(ScaledNormal, PullsAHeldUnknownToItsValue) {
  const Eigen::Matrix2d normal = Eigen::Vector2d(4, 1).asDiagonal();
  Vector2d right(8, 3);
  ScaledNormal<Eigen::Matrix2d> equations(normal);
  equations.hold(1, 7, 1e9, right);
  const Vector2d x = equations.solve(right);
  EXPECT_NEAR(x[0], 2, 1e-12);
  EXPECT_NEAR(x[1], 7, 1e-6);
}

}  // namespace
}  // namespace thimble::math
