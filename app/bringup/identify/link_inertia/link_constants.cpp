#include "bringup/identify/link_inertia/link_constants.h"

#include <algorithm>
#include <cmath>

#include "gravity_terms.h"
#include "plant/link_mechanics.h"

namespace thimble::bringup {
namespace {

// Written constants as a function of the seen ones: mass, inertias, yaws and moment_b as in
// LinkFit, weight.
constexpr int kSeenLinks = 8, kWrittenLinks = 10;
using SeenLinks = Eigen::Matrix<double, kSeenLinks, 1>;
using WrittenLinks = Eigen::Matrix<double, kWrittenLinks, 1>;
struct Of {
  enum Index { kMass, kA, kB, kC, kYawB, kYawC, kCoupling, kMomentB, kMomentC, kWeight };
};

// kg, min. mass at the tip in an arm file.
constexpr double kTipMin = 1e-3;

/// Moves a mass from the tip to the elbow's coupling.
WrittenLinks links_with_coupling(const SeenLinks& seen, const driver::SerialArm& arm, double mass) {
  const double lb = arm.length_b, lc = arm.length_c;
  WrittenLinks is;
  is.head<6>() = seen.head<6>();
  is[Of::kMass] -= mass;
  is[Of::kB] += mass * lb * lb;
  is[Of::kC] += mass * lc * lc;
  is[Of::kYawB] += mass * lb * lb;
  is[Of::kYawC] += mass * lc * lc;
  is[Of::kCoupling] = mass * lb * lc;
  const double moment = std::min(0.0, seen[7]) / scene::kGravity;
  is[Of::kMomentB] = seen[6] + moment * lb;
  is[Of::kMomentC] = moment * lc;
  is[Of::kWeight] = std::max(0.0, seen[7]);
  return is;
}

driver::Result<void> check_written(const WrittenLinks& is) {
  device_sim::LinkSettings links;
  // Values written with six digits must be accepted too.
  constexpr double kRounding = 2e-5;
  links.inertia = is.segment<3>(Of::kA);
  const double about_yaw = is[Of::kA] + std::abs(is[Of::kYawB]) + std::abs(is[Of::kYawC]);
  links.inertia.tail<2>() *= 1 - 2 * kRounding;
  links.yaw_b = is[Of::kYawB] - kRounding * about_yaw;
  links.yaw_c = is[Of::kYawC] - kRounding * about_yaw;
  links.coupling = is[Of::kCoupling];
  return device_sim::check_links(links);
}

driver::Result<WrittenLinks> written_links(const SeenLinks& seen, const driver::SerialArm& arm) {
  const auto at = [&](double mass) { return links_with_coupling(seen, arm, mass); };
  double upper = seen[0] - kTipMin, lower = 0;
  if (check_written(at(0))) return at(0);
  if (auto good = check_written(at(upper)); !(upper > 0) || !good) {
    return driver::Error{
        "No physical links fit this motion: the inertia would be negative in some pose. Check the "
        "arm for backlash and rubbing parts, and record for longer (--duration)."};
  }
  // More coupling means more inertia everywhere.
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (lower + upper);
    (check_written(at(middle)) ? upper : lower) = middle;
  }
  return at(upper);
}

}  // namespace

driver::Result<TipAndLinks> tip_and_links(const LinkFit& fit, const Eigen::Vector3d& down_B) {
  Eigen::Matrix<double, kSeenLinks, LinkFit::kCount> look =
      Eigen::Matrix<double, kSeenLinks, LinkFit::kCount>::Zero();
  look.topLeftCorner<7, 7>().setIdentity();
  look.block<1, 3>(7, LinkFit::kWeight) = down_B.transpose();
  SeenLinks seen = look * fit.theta;
  const Eigen::Matrix<double, kSeenLinks, kSeenLinks> covariance =
      look * fit.covariance * look.transpose();
  const SeenLinks deviation = covariance.diagonal().cwiseSqrt();
  // An inertia A that does not differ significantly from zero may be found below zero; coupling
  // cannot correct that.
  if (seen[Of::kA] < 0 && seen[Of::kA] > -kNormal95 * deviation[Of::kA]) seen[Of::kA] = 0;
  const auto found = written_links(seen, fit.arm);
  if (!found) return found.error();
  Eigen::Matrix<double, kWrittenLinks, kSeenLinks> slope;
  for (int k = 0; k < kSeenLinks; ++k) {
    const double step = 0.01 * deviation[k];
    SeenLinks more = seen;
    more[k] += step;
    const auto there = written_links(more, fit.arm);
    if (!there) return there.error();
    slope.col(k) =
        step > 0 ? WrittenLinks((*there - *found) / step) : WrittenLinks(WrittenLinks::Zero());
  }
  const WrittenLinks error =
      kNormal95 * (slope * covariance * slope.transpose()).diagonal().cwiseSqrt();
  const auto estimate = [&](int i) { return Estimate{(*found)[i], error[i]}; };
  TipAndLinks all;
  all.mass = estimate(Of::kMass);
  all.weight = estimate(Of::kWeight);
  all.links = {.inertia = {estimate(Of::kA), estimate(Of::kB), estimate(Of::kC)},
               .yaw_b = estimate(Of::kYawB),
               .yaw_c = estimate(Of::kYawC),
               .coupling = estimate(Of::kCoupling),
               .moment_b = estimate(Of::kMomentB),
               .moment_c = estimate(Of::kMomentC)};
  return all;
}

device_sim::LinkSettings settings_of(const LinkConstants& links) {
  device_sim::LinkSettings is;
  for (std::size_t i = 0; i < 3; ++i) {
    is.inertia[static_cast<Eigen::Index>(i)] = links.inertia[i].value;
  }
  is.yaw_b = links.yaw_b.value;
  is.yaw_c = links.yaw_c.value;
  is.coupling = links.coupling.value;
  is.moment_b = links.moment_b.value;
  is.moment_c = links.moment_c.value;
  return is;
}

}  // namespace thimble::bringup
