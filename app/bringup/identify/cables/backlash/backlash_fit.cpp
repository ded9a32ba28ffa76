#include "bringup/identify/cables/backlash/backlash_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "math/elementary.h"
#include "math/least_squares.h"

namespace thimble::bringup {
namespace {

using Theta = BacklashTheta;

/// The normal equations of one piece, with its state eliminated.
struct PieceEquations {
  Eigen::Matrix<double, BacklashState::kCount, Eigen::Dynamic> cross;  // of state and constants
  BacklashState::Vector down;                                          // along the state
  Eigen::LDLT<BacklashPieces::Normal> solved;
  Eigen::MatrixXd reduced;
  Eigen::VectorXd right;
  double trust = 1;
};

class BacklashSearch {
 public:
  BacklashSearch(BacklashPieces& pieces, const Theta::Vector& from, const BacklashSought& sought)
      : pieces_(pieces), theta_(from), friction_(sought.friction), parts_(pieces.pieces().size()) {
    for (int k = 0; k < Theta::kCount; ++k) {
      const bool is_play = k >= Theta::kBacklash && k < Theta::kRotorViscous;
      const bool is_free = k < Theta::kBacklash || (is_play ? sought.play : sought.friction);
      if (is_free) free_.push_back(k);
    }
  }

  void minimise(int rounds) {
    constexpr int kTriesMax = 6, kTrackedAgain = 4;
    constexpr double kGainedMin = 2e-4, kAgain = 1e-2;
    constexpr int kStuckMax = 1;
    int stuck = 0;
    pieces_.track(theta_);
    double damping = 1e-3;
    for (int round = 0; round < rounds; ++round) {
      if (round % kTrackedAgain == kTrackedAgain - 1) pieces_.track(theta_);
      build();
      const double before = sum();
      bool better = false;
      for (int tries = 0; tries < kTriesMax && !better; ++tries) {
        const std::vector<BacklashPiece> kept = pieces_.pieces();
        const Theta::Vector theta = theta_;
        step(damping);
        better = sum() < before;
        if (!better) theta_ = theta, pieces_.pieces() = kept;
        damping = std::max(1e-7, damping * (better ? 0.2 : 8));
      }
      stuck = better && before - sum() > kGainedMin * before ? 0 : stuck + 1;
      if (stuck > kStuckMax) break;
      if (stuck > 0) pieces_.track(theta_), damping = kAgain;
    }
    pieces_.settle(theta_, 3);
  }

  BacklashFit result() {
    const double lost_from = pieces_.lost_from();
    build();
    BacklashFit found;
    found.theta = theta_;
    std::size_t used = 0;
    for (const BacklashPiece& piece : pieces_.pieces()) {
      if (!(piece.left < lost_from)) continue;
      found.chi2 += piece.left;
      ++used;
    }
    const auto all = static_cast<double>(pieces_.pieces().size());
    found.pieces = used;
    found.lost = 1 - static_cast<double>(used) / all;
    found.samples = static_cast<double>(pieces_.rows() * used);
    found.misfit = found.chi2 / (found.samples - static_cast<double>(free_.size()) -
                                 static_cast<double>(BacklashState::kCount * used));
    Eigen::MatrixXd reduced;
    Eigen::VectorXd right;
    add_up([lost_from](const BacklashPiece& piece) { return piece.left < lost_from ? 1.0 : 0.0; },
           reduced, right);
    const auto count = static_cast<Eigen::Index>(free_.size());
    const Eigen::MatrixXd inverse =
        math::ScaledNormal<Eigen::MatrixXd>(reduced, 1e-10).covariance();
    for (Eigen::Index a = 0; a < count; ++a) {
      for (Eigen::Index b = 0; b < count; ++b) {
        const int i = free_[static_cast<std::size_t>(a)], j = free_[static_cast<std::size_t>(b)];
        found.covariance(i, j) = std::max(1.0, found.misfit) * inverse(a, b) *
                                 slope_of_constant(theta_, i) * slope_of_constant(theta_, j);
      }
    }
    return found;
  }

 private:
  /// Returns the minimized value: the residuals of the pieces, as if each had noise of its own in
  /// addition to that of the encoders' steps. A piece in a wrong local minimum has little weight,
  /// and is tracked again when the others give better constants.
  double sum() const {
    const auto rows = static_cast<double>(pieces_.rows());
    double all = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      all += parts_[i].trust * rows * math::log(1 + pieces_.pieces()[i].left / rows);
    }
    return all;
  }

  void build() {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      PieceEquations& part = parts_[i];
      pieces_.derivatives(theta_, free_, pieces_.pieces()[i], slopes_);
      BacklashPieces::Normal normal = slopes_.local.transpose() * slopes_.local;
      BacklashPieces::hold(normal);
      part.solved.compute(normal);
      part.cross = slopes_.local.transpose() * slopes_.global;
      part.down = slopes_.local.transpose() * slopes_.rest;
      const Eigen::MatrixXd by = part.solved.solve(part.cross);
      part.reduced = slopes_.global.transpose() * slopes_.global - part.cross.transpose() * by;
      part.right = slopes_.global.transpose() * slopes_.rest - by.transpose() * part.down;
    }
    find_trust();
  }

  /// A motor that rattles may depend on its start so steeply that derivatives are useless. A piece
  /// that claims to know a constant far better than most others gets less weight.
  void find_trust() {
    constexpr double kSteepest = 10;  // times the knowledge of three of four pieces [chosen]
    for (PieceEquations& part : parts_) part.trust = 1;
    for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(free_.size()); ++k) {
      std::vector<double> known;
      for (const PieceEquations& part : parts_) known.push_back(part.reduced(k, k));
      const auto upper = known.begin() + static_cast<std::ptrdiff_t>(3 * known.size() / 4);
      std::nth_element(known.begin(), upper, known.end());
      for (PieceEquations& part : parts_) {
        if (part.reduced(k, k) * part.trust <= kSteepest * *upper) continue;
        part.trust = kSteepest * *upper / part.reduced(k, k);
      }
    }
  }

  /// Adds up the pieces, each with its weight.
  template <class Weight>
  void add_up(const Weight& weight_of, Eigen::MatrixXd& reduced, Eigen::VectorXd& right) const {
    const auto count = static_cast<Eigen::Index>(free_.size());
    reduced = Eigen::MatrixXd::Zero(count, count);
    right = Eigen::VectorXd::Zero(count);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const double weight = parts_[i].trust * weight_of(pieces_.pieces()[i]);
      reduced += weight * parts_[i].reduced;
      right += weight * parts_[i].right;
    }
  }

  /// Holds viscous friction at zero if a step would make it negative, which may happen because
  /// motion hardly distinguishes that of the tip from those of the motors. Returns whether any was
  /// held.
  bool pin_viscous(const Eigen::VectorXd& by, math::ScaledNormal<Eigen::MatrixXd>& normal,
                   Eigen::VectorXd& right) const {
    constexpr double kPin = 1e6;  // of scaled equations, whose diagonal is one
    bool any = false;
    for (std::size_t j = 0; j < free_.size(); ++j) {
      const int k = free_[j];
      const bool viscous =
          k == Theta::kViscous || (k >= Theta::kRotorViscous && k < Theta::kRotorCoulomb);
      const auto at = static_cast<Eigen::Index>(j);
      if (!viscous || !(theta_[k] + by[at] < 0)) continue;
      normal.hold(at, theta_[k], kPin, right);
      any = true;
    }
    return any;
  }

  void step(double damping) {
    constexpr double kLogMax = 0.7;  // in one step
    Eigen::MatrixXd reduced;
    Eigen::VectorXd right;
    const auto rows = static_cast<double>(pieces_.rows());
    add_up([rows](const BacklashPiece& piece) { return 1 / (1 + piece.left / rows); }, reduced,
           right);
    math::ScaledNormal<Eigen::MatrixXd> normal(reduced, damping);
    Eigen::VectorXd by = -normal.solve(right);
    if (friction_ && pin_viscous(by, normal, right)) by = -normal.solve(right);
    for (std::size_t j = 0; j < free_.size(); ++j) {
      double& one = by[static_cast<Eigen::Index>(j)];
      const int k = free_[j];
      if (k >= Theta::kInertia && k < Theta::kBacklash) one = std::clamp(one, -kLogMax, kLogMax);
      if (k >= Theta::kBacklash && k < Theta::kRotorViscous) one = std::max(one, -theta_[k]);
      if (k < Theta::kDelay) one = std::max(one, -0.5 * theta_[k]);
      move_constant(theta_, k, one);
    }
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const PieceEquations& part = parts_[i];
      pieces_.offer(theta_, i, part.solved.solve(part.down + part.cross * by));
    }
    pieces_.settle(theta_, 1);
  }

  BacklashPieces& pieces_;
  Theta::Vector theta_;
  bool friction_;  // that of the motors is searched for
  std::vector<int> free_;
  std::vector<PieceEquations> parts_;
  BacklashSlopes slopes_;
};

}  // namespace

BacklashFit fit_backlash(BacklashPieces pieces, const Theta::Vector& from,
                         const BacklashSought& sought, int rounds) {
  BacklashSearch search(pieces, from, sought);
  search.minimise(rounds);
  return search.result();
}

}  // namespace thimble::bringup
