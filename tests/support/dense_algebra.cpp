#include "support/dense_algebra.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace thimble::support {

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
}

SymmetricAxes symmetric_axes(const Eigen::Matrix3d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

double spectral_radius(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

Eigen::Vector3d solve(const Eigen::Matrix3d& A, const Eigen::Vector3d& b) {
  return A.partialPivLu().solve(b);
}

}  // namespace thimble::support
