#include "bringup/identify/motion_fit.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstddef>

#include "bringup/identify/weak_form/clustered_fit.h"
#include "bringup/identify/weak_form/delay_search.h"
#include "bringup/identify/weak_form/fit_residual.h"
#include "bringup/identify/weak_form/motion_equations.h"

namespace thimble::bringup {
namespace {

using Row = MotionEquations::Row;

class Fit {
 public:
  Fit(const ArmMotion& motion, bool with_stiffness, bool with_inertia)
      : with_stiffness_(with_stiffness),
        with_inertia_(with_inertia),
        equations_(motion, with_inertia) {}

  driver::Result<MassNormalisedFit> run() {
    if (equations_.torn()) return MotionEquations::torn_error(equations_.motion());
    if (equations_.equations().size() < 300) {
      return driver::Error{
          "The motion cannot be fitted: it is too short, or the tip was at rest most of the time. "
          "Let it move freely for about ten seconds."};
    }
    constexpr std::size_t kSome = 8;  // enough for a first search
    double best = coarse_delay([this](double delay) { return residual_at(delay, kSome); });
    // The point at which friction reverses depends on its size.
    for (int round = 0; round < 3; ++round) {
      Row theta;
      solve(best, theta);
      equations_.find_signs(theta[MassNormalisedFit::kCoulomb]);
      best = refined_delay(best, 1e-6, [this](double delay) { return residual_at(delay); });
    }
    return at_delay(best);
  }

 private:
  /// Best constants at a delay, and the sum of squared residuals. Uses every equation, or one in
  /// `stride`.
  double solve(double delay, Row& theta, std::size_t stride = 1) const {
    Eigen::Matrix<double, MassNormalisedFit::kCount + 1, MassNormalisedFit::kCount + 1> normal;
    normal.setZero();
    Row right = Row::Zero();
    double square = 0;
    for (std::size_t i = 0; i < count(); i += stride) {
      const Row one = equations_.row(i, delay);
      normal += one * one.transpose();
      right += left_of(i) * one;
      square += left_of(i) * left_of(i);
    }
    normal(MassNormalisedFit::kCount, MassNormalisedFit::kCount) = 1;
    leave_out(normal);
    // Motors and axes that the arm does not have are in no equation.
    for (int k = 0; k < MassNormalisedFit::kCount; ++k) {
      if (normal(k, k) == 0) normal(k, k) = 1;
    }
    for (int k = 0; k < MassNormalisedFit::kCount; ++k) right[k] = is_asked(k) ? right[k] : 0;
    theta = normal.ldlt().solve(right);
    return square - theta.dot(right);
  }

  bool is_asked(int k) const {
    return k < MassNormalisedFit::kStiffness || k == MassNormalisedFit::kCount ||
           (k == MassNormalisedFit::kStiffness ? with_stiffness_ : with_inertia_);
  }

  /// Makes the equations of constants that were not requested trivial.
  void leave_out(Eigen::Matrix<double, MassNormalisedFit::kCount + 1,
                               MassNormalisedFit::kCount + 1>& normal) const {
    for (int k = 0; k < MassNormalisedFit::kCount; ++k) {
      if (is_asked(k)) continue;
      normal.row(k).setZero();
      normal.col(k).setZero();
      normal(k, k) = 1;
    }
  }

  double residual_at(double delay, std::size_t stride = 1) const {
    Row theta;
    return solve(delay, theta, stride);
  }

  MassNormalisedFit at_delay(double delay) const {
    MassNormalisedFit found;
    found.motors = equations_.motion().motors;
    Row theta;
    solve(delay, theta);
    found.theta = theta.head<MassNormalisedFit::kCount>();
    found.delay.value = delay;
    const FitResidual residual = residual_of(equations_, found);
    const Eigen::MatrixXd covariance =
        clustered_covariance(residual.rows, residual.rest, residual.clusters);
    found.covariance =
        covariance.topLeftCorner<MassNormalisedFit::kCount, MassNormalisedFit::kCount>();
    found.delay.plus_minus =
        kNormal95 * std::sqrt(covariance(MassNormalisedFit::kCount, MassNormalisedFit::kCount));
    double square = 0;
    for (std::size_t i = 0; i < count(); ++i) square += left_of(i) * left_of(i);
    found.residual = std::sqrt(residual.rest.squaredNorm() / static_cast<double>(count()));
    found.explained = 1 - residual.rest.squaredNorm() / square;
    found.noise = equations_.noise();
    found.windows = count();
    found.left_out = equations_.left_out();
    return found;
  }

  std::size_t count() const { return equations_.equations().size(); }
  double left_of(std::size_t i) const { return equations_.equations()[i].left; }

  bool with_stiffness_, with_inertia_;
  MotionEquations equations_;
};

}  // namespace

driver::Result<MassNormalisedFit> fit_motion(const ArmMotion& motion, bool with_stiffness,
                                             bool with_inertia) {
  return Fit(motion, with_stiffness, with_inertia).run();
}

}  // namespace thimble::bringup
