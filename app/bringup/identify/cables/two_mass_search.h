#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bringup/identify/cables/two_mass_fit.h"
#include "math/least_squares.h"

namespace thimble::bringup {

// The search for the constants of two_mass_fit.cpp.

using TwoMassTheta = Eigen::Matrix<double, TwoMass::kCount, 1>;

inline constexpr int kSlowRows = 7;  // of a SlowPart

inline constexpr double kNoiseMin = 1e-12;  // rad, below any encoder's

/// Returns whether the search uses the logarithm of a constant.
inline bool is_log(int k) {
  return k >= TwoMass::kCompliance || (k >= TwoMass::kInertia && k < TwoMass::kRotorViscous);
}

inline double log_of(double amount) {
  return math::log(std::max(amount, 1e-12));
}

/// Search space: logarithms of inertias, compliances and their fading, which keep them positive.
inline TwoMassTheta into_search(TwoMassTheta theta) {
  theta.tail<6>() = theta.tail<6>().unaryExpr(&log_of);
  theta.segment<3>(TwoMass::kInertia) = theta.segment<3>(TwoMass::kInertia).unaryExpr(&log_of);
  return theta;
}

inline TwoMassTheta from_search(TwoMassTheta x) {
  x.tail<6>() = x.tail<6>().unaryExpr(&math::exp);
  x.segment<3>(TwoMass::kInertia) = x.segment<3>(TwoMass::kInertia).unaryExpr(&math::exp);
  return x;
}

/// Returns the joints' oscillation at a frequency, rad.
inline Eigen::Vector3cd two_mass_answer(const TwoMassTheta& theta, const SpectralLine& line,
                                        const Eigen::Matrix3d& JTJ, double dt, bool elastic) {
  const std::complex<double> s(0, line.omega);
  const double half = 0.5 * line.omega * dt;
  const std::complex<double> held =
      math::sin(half) / half * turn_by(-line.omega * (0.5 * dt + theta[TwoMass::kDelay]));
  Eigen::Matrix3cd Z = JTJ.cast<std::complex<double>>() * (s * s + theta[TwoMass::kViscous] * s);
  if (elastic) {
    Eigen::Matrix3cd compliance = Z.inverse();
    for (int i = 0; i < 3; ++i) {
      compliance(i, i) += theta[TwoMass::kCompliance + i] / (1.0 + s * theta[TwoMass::kFade + i]);
    }
    Z = compliance.inverse();
  }
  for (int i = 0; i < 3; ++i) {
    Z(i, i) += s * s * theta[TwoMass::kInertia + i] + s * theta[TwoMass::kRotorViscous + i];
  }
  const Eigen::Vector3cd push =
      held * theta.segment<3>(TwoMass::kGain).cast<std::complex<double>>().cwiseProduct(line.tau);
  return Z.inverse() * push;
}

/// Search of Levenberg and Marquardt for the constants that fit the lines best.
class TwoMassSearch {
 public:
  TwoMassSearch(const LineSpectrum& spectrum, double dt) : spectrum_(spectrum), dt_(dt) {
    sigma_.resize(spectrum.lines.size());
  }

  /// Estimates the noise from the frequencies between the lines, without the model's response to
  /// their torques.
  void measure_noise(const TwoMassTheta& theta, bool elastic) {
    constexpr std::size_t kNoiseLines = LineSpectrum::kNoiseLines;
    std::vector<Eigen::Vector3d> power(sigma_.size(), Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < spectrum_.noise_lines.size(); ++i) {
      const SpectralLine& line = spectrum_.noise_lines[i];
      const Eigen::Vector3cd rest =
          line.q - two_mass_answer(theta, line, spectrum_.JTJ, dt_, elastic);
      power[i / kNoiseLines] += rest.cwiseAbs2() / static_cast<double>(kNoiseLines);
    }
    for (std::size_t i = 0; i < sigma_.size(); ++i) {
      // Averaged with the neighbours: eight frequencies give it only to a third.
      const std::size_t low = i == 0 ? 0 : i - 1, high = std::min(i + 1, sigma_.size() - 1);
      Eigen::Vector3d sum(0, 0, 0);
      for (std::size_t k = low; k <= high; ++k)
        sum += power[k] / static_cast<double>(high - low + 1);
      sigma_[i] = sum.cwiseSqrt().cwiseMax(kNoiseMin);
    }
  }

  /// Searches for the constants from `x`. Returns chi^2.
  double minimise(TwoMassTheta& x, bool elastic, int rounds) const {
    const int count = elastic ? TwoMass::kCount : TwoMass::kRigidCount;
    return math::levenberg_marquardt<Eigen::MatrixXd>(Problem{*this, elastic, count}, x,
                                                      {.rounds = rounds, .ridge = 1e-12});
  }

  Eigen::MatrixXd covariance(const TwoMassTheta& x, bool elastic) const {
    const int count = elastic ? TwoMass::kCount : TwoMass::kRigidCount;
    Eigen::MatrixXd slope;
    Eigen::VectorXd rest;
    jacobian(x, elastic, count, slope, rest);
    return math::ScaledNormal<Eigen::MatrixXd>(slope.transpose() * slope, kRidge).covariance();
  }

  /// Estimates compliances about a rigid arm: their values and deviations.
  void estimate_compliance(const TwoMassTheta& rigid, Eigen::Vector3d& compliance,
                           Eigen::Vector3d& error) const {
    Eigen::MatrixXd slope, all(rows(), TwoMass::kRigidCount + 3);
    Eigen::VectorXd rest, other(rows());
    jacobian(into_search(rigid), false, TwoMass::kRigidCount, slope, rest);
    all.leftCols(TwoMass::kRigidCount) = slope;
    for (int i = 0; i < 3; ++i) {
      TwoMassTheta soft = rigid;
      soft.tail<6>().setZero();
      soft[TwoMass::kCompliance + i] = 1e-7 / spectrum_.JTJ(i, i);
      residuals(soft, true, other);
      all.col(TwoMass::kRigidCount + i) = (other - rest) / soft[TwoMass::kCompliance + i];
    }
    const Eigen::MatrixXd inverse =
        math::ScaledNormal<Eigen::MatrixXd>(all.transpose() * all, kRidge).covariance();
    const Eigen::VectorXd step = inverse * (all.transpose() * rest);
    const double spread =
        std::max(1.0, rest.squaredNorm() / static_cast<double>(rows() - TwoMass::kRigidCount));
    for (int i = 0; i < 3; ++i) {
      const int k = TwoMass::kRigidCount + i;
      compliance[i] = -step[k];
      error[i] = std::sqrt(spread * inverse(k, k));
    }
  }

  Eigen::Index rows() const {
    return static_cast<Eigen::Index>(6 * spectrum_.lines.size()) +
           (slow_ != nullptr ? kSlowRows : 0);
  }

  /// From now on, includes the slow part of the motion.
  void take_slow_part(const SlowPart& slow) { slow_ = &slow; }
  const std::vector<Eigen::Vector3d>& sigma() const { return sigma_; }

 private:
  static constexpr double kRidge = 1e-10;  // of a scaled diagonal

  /// The problem for math::levenberg_marquardt.
  struct Problem {
    const TwoMassSearch& search;
    bool elastic;
    int count;  // number of constants searched for: the first ones

    double linearize(const TwoMassTheta& x, Eigen::MatrixXd& normal,
                     Eigen::VectorXd& gradient) const {
      Eigen::MatrixXd slope;
      Eigen::VectorXd rest;
      search.jacobian(x, elastic, count, slope, rest);
      normal = slope.transpose() * slope;
      gradient = slope.transpose() * rest;
      return sum_of(x, rest);
    }
    /// Bounds a step to a factor of e for logarithms.
    TwoMassTheta stepped(TwoMassTheta x, const Eigen::VectorXd& by) const {
      for (int k = 0; k < count; ++k) x[k] += is_log(k) ? std::clamp(by[k], -1.0, 1.0) : by[k];
      return x;
    }
    double sum(const TwoMassTheta& x) const {
      Eigen::VectorXd rest(search.rows());
      search.rest_at(x, elastic, rest);
      return sum_of(x, rest);
    }
  };

  void residuals(const TwoMassTheta& theta, bool elastic, Eigen::VectorXd& rest) const {
    for (std::size_t i = 0; i < spectrum_.lines.size(); ++i) {
      const SpectralLine& line = spectrum_.lines[i];
      const Eigen::Vector3cd off =
          two_mass_answer(theta, line, spectrum_.JTJ, dt_, elastic) - line.q;
      for (int joint = 0; joint < 3; ++joint) {
        // Either part has half of the noise's power.
        const std::complex<double> one = std::sqrt(2.0) * off[joint] / sigma_[i][joint];
        rest[static_cast<Eigen::Index>(6 * i) + 2 * joint] = one.real();
        rest[static_cast<Eigen::Index>(6 * i) + 2 * joint + 1] = one.imag();
      }
    }
    if (slow_ != nullptr) rest.tail<kSlowRows>() = slow_rest(theta);
  }

  /// Difference of the constants from the slow part, in its deviations.
  Eigen::Matrix<double, kSlowRows, 1> slow_rest(const TwoMassTheta& theta) const {
    Eigen::Matrix<double, kSlowRows, 1> rest;
    const Eigen::Vector3d gain = theta.segment<3>(TwoMass::kGain);
    const Eigen::Vector3d ratio = theta.segment<3>(TwoMass::kInertia).cwiseQuotient(gain);
    rest << (gain - slow_->gain).cwiseQuotient(slow_->gain_error),
        (ratio - slow_->ratio).cwiseQuotient(slow_->ratio_error),
        (theta[TwoMass::kDelay] - slow_->delay) / slow_->delay_error;
    return rest;
  }

  /// Computes the residuals of the lines for the constants at `x`.
  void rest_at(const TwoMassTheta& x, bool elastic, Eigen::VectorXd& rest) const {
    residuals(from_search(x), elastic, rest);
  }

  /// Returns the sum of squares; infinite if a motor pulls in the opposite direction, because the
  /// directions are already known.
  static double sum_of(const TwoMassTheta& x, const Eigen::VectorXd& rest) {
    const double sum = rest.squaredNorm();
    return x.segment<3>(TwoMass::kGain).minCoeff() > 0 && std::isfinite(sum) ? sum : HUGE_VAL;
  }

  void jacobian(const TwoMassTheta& x, bool elastic, int count, Eigen::MatrixXd& slope,
                Eigen::VectorXd& rest) const {
    rest.resize(rows());
    slope.resize(rows(), count);
    rest_at(x, elastic, rest);
    Eigen::VectorXd other(rows());
    for (int k = 0; k < count; ++k) {
      TwoMassTheta next = x;
      const double step = k == TwoMass::kDelay ? 1e-7
                          : is_log(k)          ? 1e-5
                                               : 1e-5 * std::max(std::abs(x[k]), floor_of(k));
      next[k] += step;
      rest_at(next, elastic, other);
      slope.col(k) = (other - rest) / step;
    }
  }

  /// Scale of a constant that may be zero.
  double floor_of(int k) const {
    if (k == TwoMass::kViscous) return 0.1;
    if (k >= TwoMass::kRotorViscous && k < TwoMass::kCompliance) {
      return 0.1 * spectrum_.JTJ(k - TwoMass::kRotorViscous, k - TwoMass::kRotorViscous);
    }
    return 1e-9;
  }

  const LineSpectrum& spectrum_;
  const SlowPart* slow_ = nullptr;
  double dt_;
  std::vector<Eigen::Vector3d> sigma_;  // RMS of the noise of a line, rad
};

}  // namespace thimble::bringup
