#include "thimble/render/multirate/local_model.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace thimble::render {
namespace {

constexpr double kTolerance = 1e-6;  // of the largest number [chosen: far above rounding]

}  // namespace

ModelFlaw flaw_of(const LocalModel& model) noexcept {
  const Eigen::Matrix3d& K = model.stiffness;
  if (!(model.p_WR.allFinite() && model.f_T_W.allFinite() && K.allFinite() &&
        model.n_W.allFinite() && std::isfinite(model.damping))) {
    return ModelFlaw::kNotFinite;
  }
  if (!(std::abs(model.n_W.norm() - 1) <= kTolerance)) return ModelFlaw::kNormal;
  if (!(model.damping >= 0)) return ModelFlaw::kNegativeDamping;
  const double most = K.cwiseAbs().maxCoeff();
  if (!((K - K.transpose()).cwiseAbs().maxCoeff() <= kTolerance * most)) {
    return ModelFlaw::kNotSymmetric;
  }
  if (!(most > 0)) {
    return model.f_T_W.isZero(0) ? ModelFlaw::kNone : ModelFlaw::kNoSurface;
  }
  // A matrix has a Cholesky factor if and only if all its eigenvalues are above 0.
  const Eigen::Matrix3d raised = K / most + kTolerance * Eigen::Matrix3d::Identity();
  if (Eigen::LLT<Eigen::Matrix3d>(raised).info() != Eigen::Success) {
    return ModelFlaw::kNegativeStiffness;
  }
  if (!(model.n_W.dot(K * model.n_W) > kTolerance * most)) return ModelFlaw::kNoSurface;
  return ModelFlaw::kNone;
}

std::string_view describe(ModelFlaw flaw) noexcept {
  switch (flaw) {
    case ModelFlaw::kNone:
      return "The model is valid.";
    case ModelFlaw::kNotFinite:
      return "A number of the local model is NaN or infinite. Look for a division by zero in the "
             "simulation.";
    case ModelFlaw::kNormal:
      return "The local model's n_W is not a unit vector. Divide it by its length.";
    case ModelFlaw::kNotSymmetric:
      return "The local model's stiffness is not symmetric, so it would add energy on a closed "
             "path. Pass it through without_negative.";
    case ModelFlaw::kNegativeStiffness:
      return "The local model's stiffness has a negative eigenvalue, so it would push the tip away "
             "with growing force. Pass it through without_negative.";
    case ModelFlaw::kNegativeDamping:
      return "The local model's damping is below 0.";
    case ModelFlaw::kNoSurface:
      return "The local model has a force or a stiffness but no stiffness along n_W, so it would "
             "never end. Set one.";
  }
  return "";
}

Eigen::Matrix3d without_negative(const Eigen::Matrix3d& stiffness) {
  if (!stiffness.allFinite()) return stiffness;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(0.5 *
                                                             (stiffness + stiffness.transpose()));
  const Eigen::Matrix3d kept = parts.eigenvectors() * parts.eigenvalues().cwiseMax(0).asDiagonal() *
                               parts.eigenvectors().transpose();
  return 0.5 * (kept + kept.transpose());  // exactly symmetric
}

}  // namespace thimble::render
