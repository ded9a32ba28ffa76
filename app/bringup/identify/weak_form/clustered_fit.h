#pragma once

#include <Eigen/Core>
#include <vector>

namespace thimble::bringup {

/// Returns the covariance of least squares whose residuals are correlated within clusters, by the
/// sandwich of their scores. A column of zeros was not requested: its variance is zero. `clusters`:
/// cluster of each row, in ascending order. Real-time: never from the servo thread.
Eigen::MatrixXd clustered_covariance(const Eigen::MatrixXd& rows, const Eigen::VectorXd& rest,
                                     const std::vector<int>& clusters);

/// Effect of further columns on a fit by least squares.
struct FurtherColumns {
  Eigen::VectorXd change;      ///< Change of the rows' own constants.
  Eigen::VectorXd factor;      ///< Factor of each further column.
  double left = 1;             ///< Remaining share of the residual's sum of squares.
  Eigen::MatrixXd covariance;  ///< Covariance of the factors, by clusters.
  double better =
      0;  ///< Gain of the Bayesian information criterion; above 0: the columns are accepted.
};

/// Fits rows and further columns together to the residual of the rows. The criterion uses Wald's
/// statistic, less the penalty for this number of constants and rows, so that correlated residuals
/// count only for the information in them. Real-time: never from the servo thread.
FurtherColumns fit_further(const Eigen::MatrixXd& rows, const Eigen::VectorXd& rest,
                           const Eigen::MatrixXd& further, const std::vector<int>& clusters);

}  // namespace thimble::bringup
