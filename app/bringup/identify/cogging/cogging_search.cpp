#include "bringup/identify/cogging/cogging_search.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace thimble::bringup {
namespace {

// A first search uses one bump in two, and one of its ticks in two: bumps overlap fourfold, and at
// 1 kHz all waves are slow.
constexpr std::size_t kBumpStride = 2;
constexpr int kTickStride = 2;
// Number of candidates compared with the best number, and the required distance: one-sided 99.9 %
// of a normal distribution.
constexpr std::size_t kNumbersCompared = 8;
constexpr double kClearlyBetter = 3.09;

/// Some of an arm's motors.
using Motors = std::array<bool, 3>;

/// Returns the motors that turned far enough to show waves of a number of periods.
Motors turned_enough(const CoggingRows& rows, double periods) {
  const Eigen::Vector3d turned = rows.turned(periods);
  return {turned[0] >= kPeriodsTurned, turned[1] >= kPeriodsTurned, turned[2] >= kPeriodsTurned};
}

/// Part of the residual of some equations of a fit that its own constants cannot absorb.
class UnexplainedRest {
 public:
  UnexplainedRest(const FittedMotion& motion, std::size_t stride) : stride_(stride) {
    const auto step = static_cast<Eigen::Index>(stride);
    const Eigen::MatrixXd& rows = motion.residual.rows;
    const Eigen::Index count = (rows.rows() + step - 1) / step;
    Eigen::MatrixXd some(count, rows.cols());
    rest_.resize(count);
    Eigen::Index used = 0;
    for (Eigen::Index k = 0; k < rows.cols(); ++k) {
      for (Eigen::Index i = 0; i < count; ++i) some(i, used) = rows(i * step, k);
      const double norm = some.col(used).norm();
      if (norm > 0) some.col(used++) /= norm;
    }
    for (Eigen::Index i = 0; i < count; ++i) rest_[i] = motion.residual.rest[i * step];
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(some.leftCols(used));
    taken_ = qr.householderQ() * Eigen::MatrixXd::Identity(count, used);
    rest_ -= taken_ * (taken_.transpose() * rest_);
  }

  /// Returns the residual with waves of some motors.
  Eigen::VectorXd with(const CoggingRows& rows, const CoggingRows::Phases& phases,
                       const Motors& motors, int every) const {
    Eigen::MatrixXd waves = rows.columns(phases, stride_, every);
    for (int joint = 0; joint < 3; ++joint) {
      if (motors[static_cast<std::size_t>(joint)]) continue;
      waves.middleCols<CoggingRows::kPerJoint>(CoggingRows::kPerJoint * joint).setZero();
    }
    waves -= taken_ * (taken_.transpose() * waves);
    for (Eigen::Index k = 0; k < waves.cols(); ++k) {
      const double norm = waves.col(k).norm();
      if (norm > 0) waves.col(k) /= norm;
    }
    Eigen::MatrixXd normal = waves.transpose() * waves;
    for (Eigen::Index k = 0; k < normal.cols(); ++k) normal(k, k) = normal(k, k) > 0 ? 1 : 1e300;
    return rest_ - waves * normal.ldlt().solve(waves.transpose() * rest_);
  }

 private:
  std::size_t stride_;
  Eigen::MatrixXd taken_;  // an orthonormal basis
  Eigen::VectorXd rest_;
};

/// Significance of the difference between two numbers: the difference of their squared residuals,
/// half second by half second, over its deviation [M Vuong 1989].
double clearer(const Eigen::VectorXd& best, const Eigen::VectorXd& other,
               const std::vector<int>& clusters) {
  double sum = 0, square = 0, of_cluster = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < best.size(); ++i) {
    of_cluster += other[i] * other[i] - best[i] * best[i];
    const auto k = static_cast<std::size_t>(i);
    if (k + 1 < clusters.size() && clusters[k + 1] == clusters[k]) continue;
    sum += of_cluster, square += of_cluster * of_cluster;
    of_cluster = 0;
    ++count;
  }
  const double variance = square - sum * sum / count;
  return variance > 0 ? sum / std::sqrt(variance) : HUGE_VAL;
}

/// Compares numbers of periods by the residual of all equations with their waves. Two numbers are
/// compared with the motors that turned far enough for both: with one more motor, the wrong number
/// would explain more than the right one.
class ComparedNumbers {
 public:
  ComparedNumbers(const FittedMotion& motion, const CoggingRows& rows)
      : rows_(rows), clusters_(motion.residual.clusters), rest_(motion, 1) {}

  bool better(double one, double other) {
    const Motors motors = turned_enough(rows_, std::min(one, other));
    return left(one, motors).squaredNorm() < left(other, motors).squaredNorm();
  }

  bool clearly_better(double one, double other) {
    const Motors motors = turned_enough(rows_, std::min(one, other));
    return clearer(left(one, motors), left(other, motors), clusters_) > kClearlyBetter;
  }

 private:
  const Eigen::VectorXd& left(double periods, const Motors& motors) {
    const auto [known, added] = left_.try_emplace({periods, motors});
    if (added) known->second = rest_.with(rows_, rows_.phases(periods), motors, 1);
    return known->second;
  }

  const CoggingRows& rows_;
  const std::vector<int>& clusters_;
  UnexplainedRest rest_;
  std::map<std::pair<double, Motors>, Eigen::VectorXd> left_;
};

/// Advances the phases by one period.
void turn_on(CoggingRows::Phases& phases, const CoggingRows::Phases& once) {
  for (std::size_t k = 0; k < phases.size(); ++k) {
    for (std::size_t joint = 0; joint < 3; ++joint) phases[k][joint] *= once[k][joint];
  }
}

}  // namespace

CoggingPeriods find_periods(const FittedMotion& motion, const CoggingRows& rows, double named) {
  CoggingPeriods found;
  const double farthest = rows.turned(1).maxCoeff();
  const double min_periods = named > 0 ? named : kCoggingPeriodsMin;
  const double max_periods = named > 0 ? named : kCoggingPeriodsMax;
  const UnexplainedRest some(motion, kBumpStride);
  std::vector<std::pair<double, double>> tried;  // residual, and the number
  const CoggingRows::Phases once = rows.phases(1);
  CoggingRows::Phases phases = rows.phases(min_periods);
  for (double periods = min_periods; periods <= max_periods; ++periods) {
    if (periods > min_periods) turn_on(phases, once);
    if (periods * farthest < kPeriodsTurned) continue;
    if (found.min_periods == 0) found.min_periods = periods;
    found.max_periods = periods;
    tried.emplace_back(
        some.with(rows, phases, turned_enough(rows, periods), kTickStride).squaredNorm(), periods);
  }
  if (tried.empty()) return found;
  std::sort(tried.begin(), tried.end());
  if (tried.size() > kNumbersCompared) tried.resize(kNumbersCompared);
  ComparedNumbers compared(motion, rows);
  found.best = tried.front().second;
  for (const auto& [left, periods] : tried) {
    if (compared.better(periods, found.best)) found.best = periods;
  }
  for (const auto& [left, periods] : tried) {
    if (periods == found.best || compared.clearly_better(found.best, periods)) continue;
    found.rivals.push_back(periods);
  }
  return found;
}

}  // namespace thimble::bringup
