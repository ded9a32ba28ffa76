#include "bringup/identify/weak_form/clustered_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "math/elementary.h"

namespace thimble::bringup {
namespace {

/// The sums of a fit, with a trivial equation for each column of zeros.
Eigen::MatrixXd normal_of(const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd normal = rows.transpose() * rows;
  for (Eigen::Index k = 0; k < normal.cols(); ++k) {
    if (normal(k, k) == 0) normal(k, k) = 1;
  }
  return normal;
}

}  // namespace

Eigen::MatrixXd clustered_covariance(const Eigen::MatrixXd& rows, const Eigen::VectorXd& rest,
                                     const std::vector<int>& clusters) {
  const Eigen::Index columns = rows.cols();
  const Eigen::MatrixXd inverse =
      normal_of(rows).ldlt().solve(Eigen::MatrixXd::Identity(columns, columns));
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(columns, columns);
  Eigen::VectorXd score = Eigen::VectorXd::Zero(columns);
  int count = 0;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    score += rest[i] * rows.row(i).transpose();
    const auto k = static_cast<std::size_t>(i);
    if (k + 1 < clusters.size() && clusters[k + 1] == clusters[k]) continue;
    meat += score * score.transpose();
    score.setZero();
    ++count;
  }
  const double fewer = static_cast<double>(count) / std::max(1, count - 1);
  return fewer * inverse * meat * inverse;
}

FurtherColumns fit_further(const Eigen::MatrixXd& rows, const Eigen::VectorXd& rest,
                           const Eigen::MatrixXd& further, const std::vector<int>& clusters) {
  Eigen::MatrixXd all(rows.rows(), rows.cols() + further.cols());
  all << rows, further;
  // Columns differ by many powers of ten in their units.
  const Eigen::VectorXd scale =
      all.colwise().norm().unaryExpr([](double norm) { return norm > 0 ? norm : 1.0; });
  all = all * scale.cwiseInverse().asDiagonal();
  const Eigen::VectorXd theta = normal_of(all).ldlt().solve(all.transpose() * rest);
  const Eigen::VectorXd left = rest - all * theta;
  const Eigen::MatrixXd covariance = clustered_covariance(all, left, clusters);
  const Eigen::Index count = further.cols();
  const Eigen::VectorXd unit = scale.tail(count).cwiseInverse();
  FurtherColumns found;
  found.left = left.squaredNorm() / rest.squaredNorm();
  found.change = theta.head(rows.cols()).cwiseQuotient(scale.head(rows.cols()));
  found.factor = theta.tail(count).cwiseProduct(unit);
  found.covariance =
      unit.asDiagonal() * covariance.bottomRightCorner(count, count) * unit.asDiagonal();
  const Eigen::MatrixXd scaled = covariance.bottomRightCorner(count, count);
  found.better = theta.tail(count).dot(scaled.ldlt().solve(theta.tail(count))) -
                 static_cast<double>(count) * math::log(static_cast<double>(rows.rows()));
  return found;
}

}  // namespace thimble::bringup
