#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "bringup/identify/link_inertia/link_equations.h"
#include "bringup/identify/link_inertia/link_fit.h"
#include "bringup/identify/weak_form/motion_equations.h"

namespace thimble::bringup {

/// The equations of several motions in one table, for least squares: the motors' forces with the
/// arm file's constants on one side, their effects on the other. Gains appear as two differences;
/// their sum is on the force side. The motions must outlive it. Real-time: never from the servo
/// thread.
class LinkRows {
 public:
  static constexpr int kConstants = LinkEquations::kCount;
  /// Columns: all but the gains as in LinkFit, two differences of gains, the known mass, the delay.
  static constexpr int kGain = LinkFit::kGain, kAdded = kGain + 2, kDelay = kAdded + 1,
                       kCount = kDelay + 1;
  using Columns = Eigen::Matrix<double, kCount, 1>;
  using StepNoise = LinkEquations::StepNoise;

  explicit LinkRows(const std::vector<ArmMotion>& motions);

  /// Finds where dry friction changes its sign, from the deceleration that it causes along each
  /// axis.
  void find_signs(const Columns& theta);

  /// Returns the motors' forces at a delay (s), joint by joint, of one equation in `stride`.
  Eigen::MatrixXd pushed(double delay, std::size_t stride = 1) const;

  /// Returns the rows of the effects of these forces; without links their columns are zero.
  Eigen::MatrixXd rows(const Eigen::MatrixXd& gains, std::size_t stride, bool with_links) const;

  /// Returns the constants of least squares; a column of zeros has the constant zero. The encoders'
  /// steps increase accelerations and so decrease masses. Their contribution to the sums is known,
  /// and is subtracted.
  Columns least_squares(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right) const;

  /// Returns the force (N) of mass, links and known mass in one equation.
  double taken(Eigen::Index number, const Columns& theta) const {
    return fixed_.row(number).head<6>().dot(theta.head<6>()) +
           theta[kAdded] * fixed_(number, kAdded);
  }
  /// Returns the contribution of the encoders' steps to the square of that force over a motion's
  /// equations of one axis, N^2.
  double noise_of(std::size_t motion, std::size_t axis, const Columns& theta) const {
    return theta.head<6>().dot(noise_at_[motion][axis] * theta.head<6>());
  }

  const std::vector<ArmMotion>& motions() const { return motions_; }
  const std::vector<MotionEquations>& equations() const { return equations_; }
  /// Returns the half second and motion of each equation, as a cluster number.
  const std::vector<int>& clusters() const { return clusters_; }
  std::size_t count() const { return count_; }
  /// Returns a motion with too many missing reports, or null.
  const ArmMotion* torn() const { return torn_; }
  bool loaded() const { return loaded_; }  ///< Some motions have a known mass.

 private:
  void fill();
  void put_frictions();

  const std::vector<ArmMotion>& motions_;
  std::vector<MotionEquations> equations_;
  Eigen::MatrixXd fixed_;  // the part that is independent of the delay
  std::vector<int> clusters_;
  StepNoise noise_ = StepNoise::Zero();             // of the encoders' steps, in all equations
  std::vector<std::array<StepNoise, 3>> noise_at_;  // in those of each motion and axis
  std::size_t count_ = 0;
  const ArmMotion* torn_ = nullptr;
  bool loaded_ = false;
};

}  // namespace thimble::bringup
