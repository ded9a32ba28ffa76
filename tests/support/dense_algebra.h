#pragma once

#include <Eigen/Core>

// References for tests, compiled once, because Eigen's decompositions take seconds to compile.
namespace thimble::support {

/// Returns the eigenvalues of a symmetric matrix in ascending order.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// Eigenvalues of a symmetric matrix in ascending order, and its eigenvectors as columns.
struct SymmetricAxes {
  Eigen::Vector3d values;
  Eigen::Matrix3d axes;
};
SymmetricAxes symmetric_axes(const Eigen::Matrix3d& matrix);

/// Returns the largest absolute eigenvalue of a square matrix.
double spectral_radius(const Eigen::MatrixXd& matrix);

/// Solves A x = b by elimination with row exchange. A must not be singular.
Eigen::Vector3d solve(const Eigen::Matrix3d& A, const Eigen::Vector3d& b);

}  // namespace thimble::support
