#pragma once

#include <Eigen/Core>
#include <vector>

namespace thimble::bringup {

/// Returns the covariance of least squares whose residuals hang together within clusters, by the
/// sandwich of their scores. A column of zeros was not asked for: its variance is zero.
/// `clusters`: which cluster each row belongs to, one after the other. Real-time: never from the
/// servo thread.
Eigen::MatrixXd clustered_covariance(const Eigen::MatrixXd& rows, const Eigen::VectorXd& rest,
                                     const std::vector<int>& clusters);

/// What further columns add to a fit by least squares.
struct FurtherColumns {
  Eigen::VectorXd change;      ///< What the rows' own constants change by.
  Eigen::VectorXd factor;      ///< Of each further column.
  double left = 1;             ///< Share of the residual's sum of squares that is left with them.
  Eigen::MatrixXd covariance;  ///< Of the factors, by clusters.
  double better =
      0;  ///< By how much the Bayesian information prefers to have them; above 0: it does.
};

/// Fits rows and further columns together to what the rows leave. The information is that of Wald's
/// statistic, less what so many constants cost for so many rows, so that residuals which hang
/// together count no more than they tell. Real-time: never from the servo thread.
FurtherColumns fit_further(const Eigen::MatrixXd& rows, const Eigen::VectorXd& rest,
                           const Eigen::MatrixXd& further, const std::vector<int>& clusters);

}  // namespace thimble::bringup
