#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "twin/twin_motion.h"
#include "twin/twin_mover.h"

namespace thimble::twin {

struct TwinWindow;

/// Fits the start of a window if motors and links move separately. Twelve numbers are found by
/// Gauss-Newton: position and velocity of the tip, and stretch and rate of each cable.
///
/// Twins with nearly the same constants respond equally near a start, so the derivatives are
/// computed once, for the first twin, and reused for later ones. Real-time: never from the servo
/// thread.
class StartFit {
 public:
  static constexpr int kNumbers = 12;

  /// Moves `window.start` to the best start of the mover. Returns the errors in the base, m, tick
  /// by tick; `lowest_square`: their squares, summed over the ticks with a report, m^2.
  Eigen::Matrix3Xd operator()(TwinMover& mover, const TwinMotion& motion, TwinWindow& window,
                              Eigen::Vector3d& lowest_square);

 private:
  using Numbers = Eigen::Matrix<double, kNumbers, 1>;
  void differ(TwinMover& mover, const TwinMotion& motion, const TwinWindow& window,
              const Eigen::Matrix3Xd& error);

  Eigen::MatrixXd slopes_;  // of the errors at ticks with a report, per step of each number
  Eigen::LDLT<Eigen::Matrix<double, kNumbers, kNumbers>> normal_;
};

}  // namespace thimble::twin
