#pragma once

#include <Eigen/Core>

// What tests compare with, compiled once: Eigen's decompositions take seconds wherever they are
// used.
namespace thimble::support {

/// Returns the eigenvalues of a symmetric matrix, rising.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// Eigenvalues, rising, and as columns the eigenvectors of a symmetric matrix.
struct SymmetricAxes {
  Eigen::Vector3d values;
  Eigen::Matrix3d axes;
};
SymmetricAxes symmetric_axes(const Eigen::Matrix3d& matrix);

/// Returns the largest absolute value of a square matrix' eigenvalues.
double spectral_radius(const Eigen::MatrixXd& matrix);

/// Returns x of A x = b, by elimination with row exchange; A is not singular.
Eigen::Vector3d solve(const Eigen::Matrix3d& A, const Eigen::Vector3d& b);

}  // namespace thimble::support
