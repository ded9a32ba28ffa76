#include "bringup/identify/link_inertia/link_rows.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

#include "bringup/identify/arm_constants.h"
#include "gravity_terms.h"

namespace thimble::bringup {

LinkRows::LinkRows(const std::vector<ArmMotion>& motions) : motions_(motions) {
  equations_.reserve(motions.size());
  for (const ArmMotion& motion : motions) {
    equations_.emplace_back(motion, false);
    if (equations_.back().torn()) torn_ = &motion;
    loaded_ = loaded_ || motion.added_mass > 0;
    count_ += equations_.back().equations().size();
  }
  fill();
}

void LinkRows::fill() {
  fixed_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count_), kCount);
  clusters_.reserve(count_);
  noise_at_.assign(motions_.size(), {StepNoise::Zero(), StepNoise::Zero(), StepNoise::Zero()});
  Eigen::Index k = 0;
  int first = 0;
  for (std::size_t n = 0; n < motions_.size(); ++n) {
    const ArmMotion& motion = motions_[n];
    const LinkEquations links(motion);
    for (const auto& equation : equations_[n].equations()) {
      fixed_(k, LinkFit::kMass) = equation.left;
      fixed_.block<1, kConstants>(k, LinkFit::kInertia) = links.row(equation).transpose();
      StepNoise& noise = noise_at_[n][static_cast<std::size_t>(equation.axis)];
      noise += links.step_noise(equation);
      fixed_(k, LinkFit::kWeight + equation.axis) = -1;
      fixed_(k, kAdded) =
          motion.added_mass * (equation.left - scene::kGravity * motion.down_B[equation.axis]);
      clusters_.push_back(first + equation.middle / MotionEquations::kCluster);
      ++k;
    }
    first += 1 + static_cast<int>(motion.samples.size()) / MotionEquations::kCluster;
    for (const StepNoise& noise : noise_at_[n]) noise_ += noise;
  }
  put_frictions();
}

void LinkRows::put_frictions() {
  Eigen::Index k = 0;
  for (const MotionEquations& motion : equations_) {
    for (std::size_t i = 0; i < motion.equations().size(); ++i, ++k) {
      const MotionEquations::Row row = motion.row(i, 0);
      fixed_(k, LinkFit::kViscous) = -row[MassNormalisedFit::kViscous];
      fixed_(k, LinkFit::kCoulomb) = -row[MassNormalisedFit::kCoulomb];
    }
  }
}

void LinkRows::find_signs(const Columns& theta) {
  for (std::size_t n = 0; n < motions_.size(); ++n) {
    const auto& samples = motions_[n].samples;
    const double mass = theta[LinkFit::kMass] + theta[kAdded] * motions_[n].added_mass;
    const Eigen::Matrix3d masses =
        mass * Eigen::Matrix3d::Identity() +
        links_at_tip(theta.segment<kConstants>(LinkFit::kInertia), samples[samples.size() / 2]);
    const double coulomb = std::max(0.0, theta[LinkFit::kCoulomb]);
    const Eigen::Vector3d yields = masses.inverse().diagonal();
    // In the first rounds, constants of no possible arm give no signs.
    if ((yields.array() > 0).all()) equations_[n].find_signs(Eigen::Vector3d(coulomb * yields));
  }
  put_frictions();
}

Eigen::MatrixXd LinkRows::pushed(double delay, std::size_t stride) const {
  Eigen::MatrixXd all(static_cast<Eigen::Index>((count_ + stride - 1) / stride), 3);
  std::size_t k = 0;
  for (const MotionEquations& motion : equations_) {
    for (std::size_t i = 0; i < motion.equations().size(); ++i, ++k) {
      if (k % stride != 0) continue;
      all.row(static_cast<Eigen::Index>(k / stride)) =
          motion.row(i, delay).segment<3>(MassNormalisedFit::kGain).transpose();
    }
  }
  return all;
}

Eigen::MatrixXd LinkRows::rows(const Eigen::MatrixXd& gains, std::size_t stride,
                               bool with_links) const {
  Eigen::MatrixXd all(gains.rows(), kCount);
  for (Eigen::Index k = 0; k < gains.rows(); ++k) {
    all.row(k) = fixed_.row(k * static_cast<Eigen::Index>(stride));
  }
  all.col(kGain) = gains.col(2) - gains.col(0);
  all.col(kGain + 1) = gains.col(2) - gains.col(1);
  if (!with_links) all.middleCols<kConstants>(LinkFit::kInertia).setZero();
  return all;
}

LinkRows::Columns LinkRows::least_squares(const Eigen::MatrixXd& rows,
                                          const Eigen::VectorXd& right) const {
  const Columns scale = rows.colwise().norm().transpose().unaryExpr(
      [](double norm) { return norm > 0 ? 1 / norm : 1.0; });
  Eigen::Matrix<double, kCount, kCount> normal = rows.transpose() * rows;
  const bool with_links = rows.col(LinkFit::kInertia).squaredNorm() > 0;
  const double share = static_cast<double>(rows.rows()) / static_cast<double>(count_);
  const Eigen::Index noisy = with_links ? 6 : 1;
  normal.topLeftCorner(noisy, noisy) -= share * noise_.topLeftCorner(noisy, noisy);
  normal = scale.asDiagonal() * normal * scale.asDiagonal();
  for (int k = 0; k < kCount; ++k) normal(k, k) = normal(k, k) == 0 ? 1 : normal(k, k);
  const Columns sum = scale.asDiagonal() * (rows.transpose() * right);
  return scale.cwiseProduct(Columns(normal.ldlt().solve(sum)));
}

}  // namespace thimble::bringup
