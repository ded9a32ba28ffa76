#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bringup/identify/cables/backlash/backlash_model.h"

namespace thimble::bringup {

/// One short piece of a motion, over which the model moves from a state of its own.
struct BacklashPiece {
  std::size_t first = 0;  ///< Tick of the motion.
  BacklashState start;
  double left = 0;  ///< Sum of squared residuals, in deviations of the encoders' steps.
};

/// Residual of a piece and its derivatives by constants and state.
struct BacklashSlopes {
  Eigen::MatrixXd global;  ///< By the constants that are searched for.
  Eigen::Matrix<double, Eigen::Dynamic, BacklashState::kCount> local;
  Eigen::VectorXd rest;
  Eigen::MatrixXd moved;  ///< Buffer for the residual with one of them changed.
};

/// Pieces of a motion, and their initial states. Real-time: never from the servo thread.
class BacklashPieces {
 public:
  using Normal = Eigen::Matrix<double, BacklashState::kCount, BacklashState::kCount>;

  /// Takes the motion, which must outlive it, the number of pieces, and the ticks of each.
  BacklashPieces(const ArmMotion& motion, std::size_t pieces, std::size_t ticks);

  /// Estimates each state from the motion before its piece (extended Kalman filter), and keeps the
  /// estimate if its residual is smaller than before.
  void track(const BacklashTheta::Vector& theta);
  /// Searches for the states only.
  void settle(const BacklashTheta::Vector& theta, int rounds);
  /// Starts piece i from its state less `step` if that gives a smaller residual: where a motor hits
  /// its cable, derivatives of a state are valid only nearby.
  void offer(const BacklashTheta::Vector& theta, std::size_t i, const BacklashState::Vector& step);
  /// Returns the residual, as in BacklashPiece::left, from which a piece has lost track of the
  /// motion: its state is in a local minimum that does not follow it.
  double lost_from() const;
  void derivatives(const BacklashTheta::Vector& theta, const std::vector<int>& free,
                   const BacklashPiece& piece, BacklashSlopes& out) const;

  /// Bounds a step of a state by the possible error of a state: an axis that dry friction holds all
  /// the time shows nothing of its velocity.
  static void hold(Normal& normal);

  std::vector<BacklashPiece>& pieces() { return pieces_; }
  const std::vector<BacklashPiece>& pieces() const { return pieces_; }
  /// Returns the number of angles of a piece.
  std::size_t rows() const { return 3 * ticks_; }

 private:
  BacklashState tracked(const BacklashTheta::Vector& theta, std::size_t first) const;
  void settle(const BacklashTheta::Vector& theta, int rounds, BacklashPiece& piece) const;
  void move_all(std::span<const BacklashRun> runs, std::size_t first, std::size_t count) const;
  /// Replaces a model's angles by its residuals. Returns the sum of squares; +inf if it is not
  /// finite.
  double rest_of(double* angles, std::size_t first) const;
  double left(const BacklashTheta::Vector& theta, const BacklashState& start, std::size_t first,
              double* rest) const;

  const ArmMotion& motion_;
  std::size_t ticks_;
  Eigen::Vector3d p_middle_{0, 0, 0};
  Eigen::Vector3d weight_{0, 0, 0};  // reciprocal of the deviation of the encoders' steps, 1/rad
  std::vector<BacklashPiece> pieces_;
};

/// Changes one of the constants by a step of the search; positive ones change by their logarithm.
void move_constant(BacklashTheta::Vector& theta, int k, double step);

/// Returns the derivative of a constant by a step of the search.
double slope_of_constant(const BacklashTheta::Vector& theta, int k);

}  // namespace thimble::bringup
