#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <limits>

namespace thimble::math {

/// Normal equations whose unknowns are scaled so that the diagonal is 1: constants of an arm differ
/// by many powers of ten in their units. An unknown without any equation stays at 0.
///
/// `Matrix` is the type of the square matrix, of fixed or dynamic size. Never from the servo
/// thread: matrices of dynamic size allocate.
template <class Matrix>
class ScaledNormal {
 public:
  using Vector = Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1>;

  /// Takes J^T J. Adds `ridge` (without unit) to the scaled diagonal, which keeps equations
  /// solvable that do not determine all unknowns.
  explicit ScaledNormal(const Matrix& normal, double ridge = 0)
      : scale_(normal.diagonal()
                   .cwiseMax(std::numeric_limits<double>::min())
                   .cwiseSqrt()
                   .cwiseInverse()),
        scaled_(scale_.asDiagonal() * normal * scale_.asDiagonal()) {
    scaled_.diagonal().array() += ridge;
  }

  /// Adds `stiffness` (without unit) that pulls unknown `k` to `value`, which expresses a bound of
  /// the unknown as an equation. Adds its part to `right`, a right side.
  void hold(Eigen::Index k, double value, double stiffness, Vector& right) {
    scaled_(k, k) += stiffness;
    right[k] += stiffness * value / (scale_[k] * scale_[k]);
  }

  /// Returns the unknowns for a right side J^T r.
  Vector solve(const Vector& right) const {
    return scale_.asDiagonal() * scaled_.ldlt().solve(Vector(scale_.asDiagonal() * right));
  }

  /// Returns the inverse of J^T J: the covariance of the unknowns if the rows of J are in units of
  /// their noise.
  Matrix covariance() const {
    const Matrix one = Matrix::Identity(scaled_.rows(), scaled_.cols());
    return scale_.asDiagonal() * scaled_.ldlt().solve(one) * scale_.asDiagonal();
  }

 private:
  Vector scale_;
  Matrix scaled_;
};

/// Stop conditions and damping of levenberg_marquardt.
struct SearchEffort {
  int rounds = 30;           ///< Max. number of rounds.
  int tries = 8;             ///< Max. number of steps per round until one is better.
  double min_gain = 1e-6;    ///< Stops when a round gains less than this share.
  double damping = 1e-2;     ///< Damping of the first step, relative to the diagonal.
  double max_damping = 1e6;  ///< Stops when no step with less damping is better.
  double raised = 5;         ///< Factor of the damping after a step that is not better.
  double lowered = 0.2;      ///< Factor of the damping after a better step.
  double ridge = 0;          ///< Added to the diagonal, as a share of its largest element.
};

/// Minimizes a sum of squares from `x` by the steps of Levenberg and Marquardt. The damping is
/// scaled by the diagonal of J^T J (D W Marquardt, An algorithm for least-squares estimation of
/// nonlinear parameters, 1963). Changes `x` only to values with a smaller sum. Returns the sum of
/// squares; it does not include priors.
///
/// `Problem` has:
/// - `double linearize(const X& x, Matrix& normal, Vector& gradient)`: fills J^T J and J^T r, with
///   priors in the former only; returns the sum of squares at x;
/// - `X stepped(const X& x, const Vector& by)`: the point after a step, which it may bound;
/// - `double sum(const X& x)`: the sum of squares; infinite or not a number where x is not allowed.
template <class Matrix, class X, class Problem>
double levenberg_marquardt(const Problem& problem, X& x, const SearchEffort& effort) {
  using Vector = Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1>;
  double best = 0, damping = effort.damping;
  Matrix normal;
  Vector gradient;
  for (int round = 0; round < effort.rounds && damping < effort.max_damping; ++round) {
    best = problem.linearize(x, normal, gradient);
    double gained = 0;
    for (int tries = 0; tries < effort.tries && gained == 0 && damping < effort.max_damping;
         ++tries) {
      Matrix damped = normal;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += effort.ridge * normal.diagonal().maxCoeff();
      const X next = problem.stepped(x, Vector(-damped.ldlt().solve(gradient)));
      const double sum = problem.sum(next);
      const bool better = sum < best;
      damping *= better ? effort.lowered : effort.raised;
      if (!better) continue;
      gained = best - sum;
      best = sum;
      x = next;
    }
    if (!(gained > effort.min_gain * best)) break;
  }
  return best;
}

}  // namespace thimble::math
