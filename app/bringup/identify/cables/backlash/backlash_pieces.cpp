#include "bringup/identify/cables/backlash/backlash_pieces.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "math/elementary.h"
#include "math/least_squares.h"

namespace thimble::bringup {
namespace {

using Theta = BacklashTheta;

constexpr int kStates = BacklashState::kCount;
// Ticks that are filtered before a piece: twice the slowest oscillation of a link on its cable
// [chosen]. Also the ticks at the beginning and end of the motion in which no piece begins or ends,
// because of smoothing.
constexpr std::size_t kTracked = 120, kLeadTicks = 160, kEndTicks = 40;
// Ratio to the median residual from which a piece has lost track [chosen].
constexpr double kLost = 5;

bool is_backlash_log(int k) {
  return k >= Theta::kInertia && k < Theta::kBacklash;
}

/// Returns the change of a constant for its derivative: small compared with its uncertainty, large
/// compared with rounding.
double probe_of_constant(const Theta::Vector& theta, int k) {
  if (is_backlash_log(k)) return 1e-4;
  if (k < Theta::kDelay) return 1e-4 * theta[k];
  if (k == Theta::kDelay) return 1e-6;
  if (k >= Theta::kRotorViscous) return k < Theta::kRotorCoulomb ? 1e-4 : 1e-3;
  return k >= Theta::kBacklash ? 2e-6 : 1e-3;
}

double probe_of_state(int k) {
  return k < 3 || (k >= 6 && k < 9) ? 1e-6 : 1e-4;
}

/// Fits a parabola to the encoder values within `reach` ticks of one: value and slope.
void smooth_about(const ArmMotion& motion, std::size_t at, int reach, Eigen::Vector3d& value,
                  Eigen::Vector3d& slope) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), right = Eigen::Matrix3d::Zero();
  for (int i = -reach; i <= reach; ++i) {
    const double t = static_cast<double>(i) / reach;
    const Eigen::Vector3d basis(1, t, t * t);
    const auto tick = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + i);
    normal += basis * basis.transpose();
    right += basis * motion.samples[tick].q.transpose();
  }
  const Eigen::Matrix3d solved = normal.ldlt().solve(right);
  value = solved.row(0);
  slope = solved.row(1) / (reach * motion.dt);
}

}  // namespace

void move_constant(Theta::Vector& theta, int k, double step) {
  if (is_backlash_log(k)) {
    theta[k] *= math::exp(step);
  } else {
    theta[k] += step;
  }
}

double slope_of_constant(const Theta::Vector& theta, int k) {
  return is_backlash_log(k) ? theta[k] : 1;
}

BacklashPieces::BacklashPieces(const ArmMotion& motion, std::size_t pieces, std::size_t ticks)
    : motion_(motion), ticks_(ticks) {
  weight_ = std::sqrt(12.0) * motion.step.cwiseInverse();
  for (const MotionSample& sample : motion.samples) {
    p_middle_ += sample.p_BT / static_cast<double>(motion.samples.size());
  }
  const std::size_t room = motion.samples.size() - kLeadTicks - kEndTicks;
  const std::size_t max_pieces = std::min<std::size_t>(pieces, room / ticks);
  for (std::size_t i = 0; i < max_pieces; ++i) {
    BacklashPiece piece;
    piece.first = kLeadTicks + i * (room - ticks) / std::max<std::size_t>(1, max_pieces - 1);
    piece.left = HUGE_VAL;
    pieces_.push_back(piece);
  }
}

BacklashState BacklashPieces::tracked(const Theta::Vector& theta, std::size_t first) const {
  // Squared error of the model per tick, and of the initial state: rad, rad/s, m, m/s [chosen: a
  // step of an encoder and the error of smoothing].
  Normal drift = Normal::Zero(), P = Normal::Zero();
  drift.diagonal() << Eigen::Vector3d::Constant(1e-12), Eigen::Vector3d::Constant(1e-4),
      Eigen::Vector3d::Constant(1e-12), Eigen::Vector3d::Constant(1e-6);
  P.diagonal() << Eigen::Vector3d::Constant(1e-8), Eigen::Vector3d::Constant(1e-2),
      Eigen::Vector3d::Constant(1e-7), Eigen::Vector3d::Constant(1e-3);
  std::size_t at = first - kTracked;
  Eigen::Vector3d q, rate, slow_q, slow_rate;
  smooth_about(motion_, at, 5, q, rate);
  smooth_about(motion_, at, 20, slow_q, slow_rate);
  const Eigen::Matrix3d J = motion_.samples[at].G.inverse();
  BacklashState now;
  now.q() = q;
  now.rate() = rate;
  now.p() = motion_.samples[at].p_BT + J * (slow_q - motion_.samples[at].q);
  now.v() = J * slow_rate;
  for (; at < first; ++at) {
    std::array<BacklashState, kStates + 1> moved;
    moved.fill(now);
    for (int k = 0; k < kStates; ++k) moved[static_cast<std::size_t>(k)].x[k] += probe_of_state(k);
    std::array<BacklashRun, kStates + 1> runs;
    for (std::size_t k = 0; k < runs.size(); ++k) runs[k] = {&theta, &moved[k], nullptr};
    move_all(runs, at, 1);
    const BacklashState& next = moved[kStates];
    Normal F;
    for (int k = 0; k < kStates; ++k) {
      F.col(k) = (moved[static_cast<std::size_t>(k)].x - next.x) / probe_of_state(k);
    }
    P = F * P * F.transpose() + drift;
    now = next;
    const MotionSample& seen = motion_.samples[at + 1];
    if (!seen.fresh) continue;
    Eigen::Matrix3d S = P.topLeftCorner<3, 3>();
    S.diagonal() += weight_.cwiseInverse().cwiseAbs2();
    const Eigen::Matrix<double, kStates, 3> K = P.leftCols<3>() * S.inverse();
    now.x += K * (seen.q - now.q());
    P = (P - K * P.topRows<3>()).eval();
    P = (0.5 * (P + P.transpose())).eval();
  }
  return now;
}

void BacklashPieces::hold(Normal& normal) {
  // rad, rad/s, m, m/s [chosen: far more than the error of a filtered state].
  constexpr double kStateStepMax[] = {1e-3, 1, 1e-3, 0.3};
  for (int k = 0; k < kStates; ++k)
    normal(k, k) += 1 / (kStateStepMax[k / 3] * kStateStepMax[k / 3]);
}

void BacklashPieces::track(const Theta::Vector& theta) {
  constexpr int kRounds = 12;
  for (BacklashPiece& piece : pieces_) {
    BacklashPiece other = piece;
    other.start = tracked(theta, piece.first);
    settle(theta, kRounds, other);
    if (other.left < piece.left) piece = other;
  }
}

void BacklashPieces::settle(const Theta::Vector& theta, int rounds, BacklashPiece& piece) const {
  // The initial state of a piece as a problem for math::levenberg_marquardt.
  struct Problem {
    const BacklashPieces& pieces;
    const Theta::Vector& theta;
    const BacklashPiece& piece;
    BacklashSlopes& slope;
    std::vector<double>& rest;

    double linearize(const BacklashState& start, Normal& normal,
                     BacklashState::Vector& gradient) const {
      BacklashPiece at = piece;
      at.start = start;
      pieces.derivatives(theta, {}, at, slope);
      normal = slope.local.transpose() * slope.local;
      hold(normal);
      gradient = slope.local.transpose() * slope.rest;
      return slope.rest.squaredNorm();
    }
    BacklashState stepped(BacklashState start, const BacklashState::Vector& by) const {
      start.x += by;
      return start;
    }
    double sum(const BacklashState& start) const {
      return pieces.left(theta, start, piece.first, rest.data());
    }
  };
  BacklashSlopes slope;
  std::vector<double> rest(rows());
  BacklashState start = piece.start;
  piece.left = math::levenberg_marquardt<Normal>(
      Problem{*this, theta, piece, slope, rest}, start,
      {.rounds = rounds, .tries = 6, .min_gain = 1e-3, .damping = 1e-3, .raised = 8});
  piece.start = start;
}

void BacklashPieces::settle(const Theta::Vector& theta, int rounds) {
  for (BacklashPiece& piece : pieces_) settle(theta, rounds, piece);
}

void BacklashPieces::offer(const Theta::Vector& theta, std::size_t i,
                           const BacklashState::Vector& step) {
  std::vector<double> rest(rows());
  BacklashPiece& piece = pieces_[i];
  BacklashState other = piece.start;
  other.x -= step;
  piece.left = left(theta, piece.start, piece.first, rest.data());
  const double sum = left(theta, other, piece.first, rest.data());
  if (!(sum < piece.left)) return;
  piece.left = sum;
  piece.start = other;
}

void BacklashPieces::move_all(std::span<const BacklashRun> runs, std::size_t first,
                              std::size_t count) const {
  for (; !runs.empty(); runs = runs.subspan(std::min(kBacklashRunsAtOnce, runs.size()))) {
    move_backlash_models(motion_, p_middle_, runs.first(std::min(kBacklashRunsAtOnce, runs.size())),
                         first, count);
  }
}

double BacklashPieces::rest_of(double* angles, std::size_t first) const {
  double sum = 0;
  for (std::size_t i = 0; i < ticks_; ++i) {
    const MotionSample& seen = motion_.samples[first + i];
    for (int k = 0; k < 3; ++k) {
      double& one = angles[3 * i + static_cast<std::size_t>(k)];
      one = seen.fresh ? (one - seen.q[k]) * weight_[k] : 0;
      sum += one * one;
    }
  }
  return std::isfinite(sum) ? sum : HUGE_VAL;
}

double BacklashPieces::left(const Theta::Vector& theta, const BacklashState& start,
                            std::size_t first, double* rest) const {
  BacklashState moved = start;
  const BacklashRun run{&theta, &moved, rest};
  move_all({&run, 1}, first, ticks_);
  return rest_of(rest, first);
}

double BacklashPieces::lost_from() const {
  std::vector<double> all;
  for (const BacklashPiece& piece : pieces_) all.push_back(piece.left);
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return kLost * std::max(*middle, static_cast<double>(rows()));
}

void BacklashPieces::derivatives(const Theta::Vector& theta, const std::vector<int>& free,
                                 const BacklashPiece& piece, BacklashSlopes& out) const {
  const auto count = static_cast<Eigen::Index>(rows());
  const std::size_t constants = free.size(), all = constants + kStates + 1;
  out.moved.resize(count, static_cast<Eigen::Index>(all));
  // The constants, each changed by its probe; the states; and at the end the unchanged ones.
  std::vector<Theta::Vector> thetas(constants, theta);
  std::vector<BacklashState> states(all, piece.start);
  std::vector<BacklashRun> runs(all);
  Eigen::VectorXd probe(static_cast<Eigen::Index>(all - 1));
  for (std::size_t j = 0; j < all; ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    if (j < constants) {
      probe[at] = probe_of_constant(theta, free[j]);
      move_constant(thetas[j], free[j], probe[at]);
    } else if (j + 1 < all) {
      const int k = static_cast<int>(j - constants);
      probe[at] = probe_of_state(k);
      states[j].x[k] += probe[at];
    }
    runs[j] = {j < constants ? &thetas[j] : &theta, &states[j], out.moved.col(at).data()};
  }
  move_all(runs, piece.first, ticks_);
  for (Eigen::Index at = 0; at < out.moved.cols(); ++at)
    rest_of(out.moved.col(at).data(), piece.first);
  out.rest = out.moved.rightCols<1>();
  const auto slope = [&](Eigen::Index at) { return (out.moved.col(at) - out.rest) / probe[at]; };
  const auto globals = static_cast<Eigen::Index>(constants);
  out.global.resize(count, globals);
  out.local.resize(count, kStates);
  for (Eigen::Index j = 0; j < globals; ++j) out.global.col(j) = slope(j);
  for (int k = 0; k < kStates; ++k) out.local.col(k) = slope(globals + k);
}

}  // namespace thimble::bringup
