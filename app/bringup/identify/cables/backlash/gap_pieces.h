#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bringup/identify/cables/backlash/gap_model.h"

namespace thimble::bringup {

/// One short piece of a motion over which the model moves from a state of its own.
struct GapPiece {
  std::size_t first = 0;  ///< Tick of the motion.
  GapState start;
  double left = 0;  ///< Squares of what the model leaves, in deviations of the encoders' steps.
};

/// What a piece leaves, by its constants and its state: slopes of the first.
struct GapSlopes {
  Eigen::MatrixXd global;  ///< By the constants that are searched for.
  Eigen::Matrix<double, Eigen::Dynamic, GapState::kCount> local;
  Eigen::VectorXd rest;
  Eigen::MatrixXd moved;  ///< Room for what is left with one of them moved.
};

/// Pieces of a motion, and the states that they begin with. Real-time: never from the servo thread.
class GapPieces {
 public:
  using Normal = Eigen::Matrix<double, GapState::kCount, GapState::kCount>;

  /// Takes the motion, which must outlive it, how many pieces, and of how many ticks each.
  GapPieces(const ArmMotion& motion, std::size_t pieces, std::size_t ticks);

  /// Filters each state from what was seen before its piece (extended Kalman filter), and keeps it
  /// where it leaves less than the one that was there.
  void track(const GapTheta::Vector& theta);
  /// Searches for the states alone.
  void settle(const GapTheta::Vector& theta, int rounds);
  /// Lets piece i begin at its state less `step`, if that leaves less than the state as it is:
  /// where a motor hits its cable the slopes of a state do not reach far.
  void offer(const GapTheta::Vector& theta, std::size_t i, const GapState::Vector& step);
  /// Returns from what on a piece has lost the track of the motion: some valley of its state in
  /// which it cannot stay. In terms of GapPiece::left.
  double lost_from() const;
  void slopes(const GapTheta::Vector& theta, const std::vector<int>& free, const GapPiece& piece,
              GapSlopes& out) const;

  /// Keeps a step of a state within what a state can be wrong by: an axis that dry friction holds
  /// all the time shows nothing of its velocity.
  static void hold(Normal& normal);

  std::vector<GapPiece>& pieces() { return pieces_; }
  const std::vector<GapPiece>& pieces() const { return pieces_; }
  /// Returns how many angles a piece has.
  std::size_t rows() const { return 3 * ticks_; }

 private:
  GapState tracked(const GapTheta::Vector& theta, std::size_t first) const;
  void settle(const GapTheta::Vector& theta, int rounds, GapPiece& piece) const;
  void move_all(std::span<const GapRun> runs, std::size_t first, std::size_t count) const;
  /// Makes of a model's angles what it leaves. Returns the sum of squares; +inf if it is none.
  double rest_of(double* angles, std::size_t first) const;
  double left(const GapTheta::Vector& theta, const GapState& start, std::size_t first,
              double* rest) const;

  const ArmMotion& motion_;
  std::size_t ticks_;
  Eigen::Vector3d p_middle_{0, 0, 0};
  Eigen::Vector3d weight_{0, 0, 0};  // one over the deviation of the encoders' steps, 1/rad
  std::vector<GapPiece> pieces_;
};

/// Moves one of the constants by a step of the search: those that are positive by their logarithm.
void move_constant(GapTheta::Vector& theta, int k, double step);

/// Returns the derivative of a constant by a step of the search.
double slope_of_constant(const GapTheta::Vector& theta, int k);

}  // namespace thimble::bringup
