#include "twin/start_fit.h"

#include <algorithm>
#include <cmath>

#include "twin/replay.h"

namespace thimble::twin {
namespace {

using Numbers = Eigen::Matrix<double, StartFit::kNumbers, 1>;

constexpr int kRounds = 6;  // max. rounds of Gauss-Newton
constexpr int kRecomputedMax =
    3;                      // max. number of times that the first fit computes its differences
constexpr int kHalves = 2;  // halvings of a step without improvement
constexpr double kSettled = 1e-4;  // share of the squared error; a smaller gain ends the search
// Share of each diagonal element; needed for cables too stiff to show their rate
constexpr double kRidge = 1e-9;

/// Steps of the differences: a fraction of the encoders' resolution of each, so that friction
/// reverses at the same tick. [chosen]
const Numbers& steps() {
  static const Numbers all = [] {
    Numbers step;
    step << 5e-6, 5e-6, 5e-6,  // m
        5e-4, 5e-4, 5e-4,      // m/s
        2e-5, 2e-5, 2e-5,      // rad
        1e-2, 1e-2, 1e-2;      // rad/s
    return step;
  }();
  return all;
}

TwinStart moved(const TwinStart& start, const Numbers& by) {
  return {.p_BT = start.p_BT + by.segment<3>(0),
          .v_BT = start.v_BT + by.segment<3>(3),
          .stretch = start.stretch + by.segment<3>(6),
          .stretch_rate = start.stretch_rate + by.segment<3>(9)};
}

/// Returns the difference between a twin and the recording, m, tick by tick.
Eigen::Matrix3Xd error_of(TwinMover& mover, const TwinMotion& motion, const TwinWindow& window,
                          const TwinStart& start) {
  std::vector<Eigen::Vector3d> seen(window.seen.size());
  mover.move(window.stretch, window.begin, start, seen);
  const std::vector<TwinSample>& samples = motion.stretches[window.stretch];
  Eigen::Matrix3Xd error(3, static_cast<Eigen::Index>(seen.size()));
  for (std::size_t j = 0; j < seen.size(); ++j) {
    error.col(static_cast<Eigen::Index>(j)) = seen[j] - samples[window.begin + j].p_BT;
  }
  return error;
}

/// Returns the errors at the ticks with a report as one vector.
Eigen::VectorXd of_reports(const Eigen::Matrix3Xd& error, const std::vector<bool>& seen) {
  const auto count = std::count(seen.begin(), seen.end(), true);
  Eigen::VectorXd column(3 * count);
  Eigen::Index row = 0;
  for (std::size_t j = 0; j < seen.size(); ++j) {
    if (!seen[j]) continue;
    column.segment<3>(row) = error.col(static_cast<Eigen::Index>(j));
    row += 3;
  }
  return column;
}

}  // namespace

void StartFit::differ(TwinMover& mover, const TwinMotion& motion, const TwinWindow& window,
                      const Eigen::Matrix3Xd& error) {
  const Eigen::VectorXd here = of_reports(error, window.seen);
  slopes_.resize(here.size(), kNumbers);
  for (int i = 0; i < kNumbers; ++i) {
    const Numbers by = steps()[i] * Numbers::Unit(i);
    slopes_.col(i) =
        of_reports(error_of(mover, motion, window, moved(window.start, by)), window.seen) - here;
  }
  Eigen::Matrix<double, kNumbers, kNumbers> normal = slopes_.transpose() * slopes_;
  const double largest = normal.diagonal().maxCoeff();
  normal.diagonal().array() += kRidge * largest;
  normal_.compute(normal);
}

Eigen::Matrix3Xd StartFit::operator()(TwinMover& mover, const TwinMotion& motion,
                                      TwinWindow& window, Eigen::Vector3d& lowest_square) {
  Eigen::Matrix3Xd best = error_of(mover, motion, window, window.start);
  Eigen::VectorXd reports = of_reports(best, window.seen);
  int recomputations = slopes_.size() == 0 ? kRecomputedMax : 0;
  bool old = true;
  for (int round = 0; round < kRounds; ++round) {
    if (old && recomputations > 0) {
      differ(mover, motion, window, best);
      --recomputations;
    }
    old = true;
    Numbers by = -normal_.solve(slopes_.transpose() * reports);
    by.array() *= steps().array();
    double gained = 0;
    for (int half = 0; half <= kHalves && !(gained > 0); ++half, by /= 2) {
      const TwinStart start = moved(window.start, by);
      Eigen::Matrix3Xd error = error_of(mover, motion, window, start);
      Eigen::VectorXd there = of_reports(error, window.seen);
      // Written so that a motion that is not a number is never the best.
      if (!(there.squaredNorm() < reports.squaredNorm())) continue;
      gained = 1 - there.squaredNorm() / reports.squaredNorm();
      window.start = start;
      best = std::move(error);
      reports = std::move(there);
    }
    if (gained < kSettled && recomputations == 0) break;
    // Differences whose prediction was good are kept.
    old = gained < 0.5;
  }
  lowest_square.setZero();
  for (std::size_t j = 0; j < window.seen.size(); ++j) {
    if (window.seen[j]) lowest_square += best.col(static_cast<Eigen::Index>(j)).cwiseAbs2();
  }
  return best;
}

}  // namespace thimble::twin
