#include "bringup/identify/weak_form/fit_residual.h"

#include <algorithm>

namespace thimble::bringup {

FitResidual residual_of(const MotionEquations& equations, const MassNormalisedFit& fit) {
  constexpr double kStep = 2e-5;  // s, of a central difference
  const auto& all = equations.equations();
  const auto count = static_cast<Eigen::Index>(all.size());
  MotionEquations::Row theta = MotionEquations::Row::Zero();
  theta.head<MassNormalisedFit::kCount>() = fit.theta;
  const double delay = fit.delay.value, early = std::max(0.0, delay - kStep);
  FitResidual found;
  found.rows.resize(count, MassNormalisedFit::kCount + 1);
  found.rest.resize(count);
  found.clusters.reserve(all.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto number = static_cast<std::size_t>(i);
    MotionEquations::Row row = equations.row(number, delay);
    found.rest[i] = all[number].left - row.dot(theta);
    for (int k = 0; k < MassNormalisedFit::kCount; ++k) row[k] = theta[k] == 0 ? 0 : row[k];
    row[MassNormalisedFit::kCount] =
        (equations.row(number, delay + kStep) - equations.row(number, early)).dot(theta) /
        (delay + kStep - early);
    found.rows.row(i) = row.transpose();
    found.clusters.push_back(all[number].middle / MotionEquations::kCluster);
  }
  return found;
}

}  // namespace thimble::bringup
