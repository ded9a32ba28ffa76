#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "twin/twin_motion.h"
#include "twin/twin_mover.h"

namespace thimble::twin {

struct TwinWindow;

/// Fits how a window began where motors and links move apart: place and velocity of the tip, and
/// stretch and rate of each cable, twelve numbers, by Gauss-Newton.
///
/// Twins of nearly the same constants move alike about a start, so that the differences are taken
/// once, by the first, and serve all that come later. Real-time: never from the servo thread.
class StartFit {
 public:
  static constexpr int kNumbers = 12;

  /// Moves `window.start` to where the mover comes nearest. Returns the errors in the base, m, tick
  /// by tick; `least`: their squares, summed over the ticks that had a report, m^2.
  Eigen::Matrix3Xd operator()(TwinMover& mover, const TwinMotion& motion, TwinWindow& window,
                              Eigen::Vector3d& least);

 private:
  using Numbers = Eigen::Matrix<double, kNumbers, 1>;
  void differ(TwinMover& mover, const TwinMotion& motion, const TwinWindow& window,
              const Eigen::Matrix3Xd& error);

  Eigen::MatrixXd slopes_;  // of the errors at ticks that had a report, over each number's step
  Eigen::LDLT<Eigen::Matrix<double, kNumbers, kNumbers>> normal_;
};

}  // namespace thimble::twin
