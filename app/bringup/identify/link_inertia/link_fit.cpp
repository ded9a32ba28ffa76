#include "bringup/identify/link_inertia/link_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/link_inertia/link_rows.h"
#include "bringup/identify/weak_form/clustered_fit.h"
#include "bringup/identify/weak_form/delay_search.h"
#include "bringup/identify/weak_form/motion_equations.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

constexpr int kLinkConstants = LinkRows::kConstants, kLinkColumns = LinkRows::kCount;
constexpr int kGainColumn = LinkRows::kGain, kAddedColumn = LinkRows::kAdded,
              kDelayColumn = LinkRows::kDelay;
// Error of a mass due to the smoothing of rates and signs, beyond the statistics [chosen: that of
// motion at one pose, kMethodMass of identify.cpp]. identify_places_test counts how often intervals
// hold.
constexpr double kLinkMethodMass = 0.0004;

using LinkColumns = LinkRows::Columns;
using MassTerms = Eigen::Matrix<double, 3, 6>;

/// Factors of mass and the five inertias on the mass matrix' diagonal.
MassTerms masses_at(const driver::SerialArm& arm, const Eigen::Vector3d& q) {
  MotionSample there;
  there.q = q;
  there.G = arm.jacobian(q).inverse();
  MassTerms masses;
  masses.col(0).setOnes();
  for (Eigen::Index k = 0; k < 5; ++k) {
    masses.col(1 + k) = links_at_tip(LinkEquations::Row::Unit(k), there).diagonal();
  }
  return masses;
}

class LinkSearch {
 public:
  LinkSearch(const driver::SerialArm& arm, const std::vector<ArmMotion>& motions)
      : arm_(arm), table_(motions) {}

  driver::Result<LinkFit> run() {
    if (table_.torn() != nullptr) return MotionEquations::torn_error(*table_.torn());
    if (table_.motions().size() < 3 || table_.count() < 600) {
      return driver::Error{
          "Links cannot be identified: the motions are too short or too few, or the tip was at "
          "rest most of the time."};
    }
    constexpr std::size_t kSome = 8;  // enough for a first search
    double delay = coarse_delay([this](double at) { return residual_at(at, kSome); });
    for (int round = 0; round < 3; ++round) {
      table_.find_signs(solve(delay));
      delay = refined_delay(delay, 4e-6, [this](double at) { return residual_at(at); });
    }
    return found_at(delay);
  }

 private:
  LinkColumns solve(double delay) const {
    const Eigen::MatrixXd gains = table_.pushed(delay, 1);
    return table_.least_squares(table_.rows(gains, 1, true), gains.rowwise().sum());
  }

  double residual_at(double delay, std::size_t stride = 1) const {
    const Eigen::MatrixXd gains = table_.pushed(delay, stride),
                          all = table_.rows(gains, stride, true);
    const Eigen::VectorXd right = gains.rowwise().sum();
    // Motors with a wrong delay explain less: relative to all of their force.
    return (right - all * table_.least_squares(all, right)).squaredNorm() / right.squaredNorm();
  }

  /// One fit with its covariance, including the delay's column.
  struct Raw {
    LinkColumns theta;
    Eigen::MatrixXd covariance;
    double square = 0, right = 0;
    Eigen::VectorXd rest;
  };

  Raw raw_at(double delay, bool with_links) const {
    constexpr double kStep = 2e-5;  // s, of a central difference
    const double early = std::max(0.0, delay - kStep);
    const Eigen::MatrixXd gains = table_.pushed(delay, 1);
    const Eigen::VectorXd right = gains.rowwise().sum();
    Eigen::MatrixXd all = table_.rows(gains, 1, with_links);
    Raw raw;
    raw.theta = table_.least_squares(all, right);
    const Eigen::VectorXd rest = right - all * raw.theta;
    const Eigen::Vector3d gain = gains_of(raw.theta);
    all.col(kDelayColumn) = (table_.pushed(early, 1) - table_.pushed(delay + kStep, 1)) * gain /
                            (delay + kStep - early);
    const LinkColumns scale = all.colwise().norm().transpose().unaryExpr(
        [](double norm) { return norm > 0 ? 1 / norm : 1.0; });
    all = all * scale.asDiagonal();
    raw.covariance = scale.asDiagonal() * clustered_covariance(all, rest, table_.clusters()) *
                     scale.asDiagonal();
    raw.rest = rest;
    raw.square = rest.squaredNorm();
    raw.right = right.squaredNorm();
    return raw;
  }

  static Eigen::Vector3d gains_of(const LinkColumns& theta) {
    const double a = theta[kGainColumn], b = theta[kGainColumn + 1];
    return {1 + a, 1 + b, 1 - a - b};
  }

  /// Scales all constants by the known mass, or by the gains' geometric mean.
  LinkFit scaled(const Raw& raw, double delay) const {
    LinkFit found;
    const Eigen::Vector3d gain = gains_of(raw.theta);
    Eigen::Matrix<double, LinkFit::kCount, kLinkColumns> slope;
    slope.setZero();
    slope.topLeftCorner<LinkFit::kGain, LinkFit::kGain>().setIdentity();
    slope.block<3, 2>(LinkFit::kGain, kGainColumn) << 1, 0, 0, 1, -1, -1;
    Eigen::Matrix<double, LinkFit::kCount, 1> z;
    z << raw.theta.head<LinkFit::kGain>(), gain;
    double scale = 0;
    LinkColumns scale_slope = LinkColumns::Zero();
    if (table_.loaded()) {
      scale = 1 / raw.theta[kAddedColumn];
      scale_slope[kAddedColumn] = -scale * scale;
    } else {
      double log_gain = 0;
      for (const double one : gain) log_gain += math::log(std::abs(one)) / 3;
      scale = math::exp(-log_gain);
      scale_slope[kGainColumn] = -scale / 3 * (1 / gain[0] - 1 / gain[2]);
      scale_slope[kGainColumn + 1] = -scale / 3 * (1 / gain[1] - 1 / gain[2]);
    }
    slope = scale * slope + z * scale_slope.transpose();
    found.arm = arm_;
    found.theta = scale * z;
    found.covariance = slope * raw.covariance * slope.transpose();
    found.delay = {delay, kNormal95 * std::sqrt(raw.covariance(kDelayColumn, kDelayColumn))};
    found.absolute = table_.loaded();
    found.residual = scale * std::sqrt(raw.square / static_cast<double>(table_.count()));
    found.explained = 1 - raw.square / raw.right;
    found.windows = table_.count();
    return found;
  }

  driver::Result<LinkFit> found_at(double delay) const {
    const Raw with = raw_at(delay, true);
    for (const double gain : gains_of(with.theta)) {
      if (gain > 0 && (!table_.loaded() || with.theta[kAddedColumn] > 0)) continue;
      return driver::Error{
          "The arm did not follow its motors in these motions: a hand or an obstacle moved the "
          "tip."};
    }
    const auto links = with.theta.segment<kLinkConstants>(LinkFit::kInertia);
    const LinkColumns deviation = with.covariance.diagonal().cwiseSqrt();
    const Eigen::VectorXd unit = deviation.segment<kLinkConstants>(LinkFit::kInertia);
    const Eigen::MatrixXd correlation = unit.cwiseInverse().asDiagonal() *
                                        with.covariance.block<kLinkConstants, kLinkConstants>(
                                            LinkFit::kInertia, LinkFit::kInertia) *
                                        unit.cwiseInverse().asDiagonal();
    const Eigen::VectorXd normed = links.cwiseQuotient(unit);
    LinkFit found = scaled(with, delay);
    const double better = normed.dot(correlation.ldlt().solve(normed)) -
                          kLinkConstants * math::log(static_cast<double>(table_.count()));
    const double change = max_change(found);
    const Raw without = better > 0 ? Raw{} : raw_at(delay, false);
    if (better <= 0) found = scaled(without, delay);
    found.places = places_of(better > 0 ? with : without);
    found.better = better;
    found.links = better > 0;
    found.max_change = change;
    return found;
  }

  /// Mass seen at each pose: the factor of the mass force there with which the residual would
  /// vanish.
  std::vector<LinkFit::Place> places_of(const Raw& raw) const {
    std::vector<LinkFit::Place> places;
    Eigen::Index k = 0;
    for (std::size_t n = 0; n < table_.motions().size(); ++n) {
      const auto& samples = table_.motions()[n].samples;
      LinkFit::Place place{.q = samples[samples.size() / 2].q, .seen = {}};
      std::array<double, 3> square{}, along{}, of_cluster{}, spread{};
      for (const auto& equation : table_.equations()[n].equations()) {
        const auto axis = static_cast<std::size_t>(equation.axis);
        const double takes = table_.taken(k, raw.theta);
        square[axis] += takes * takes;
        along[axis] += takes * raw.rest[k];
        of_cluster[axis] += takes * raw.rest[k];
        ++k;
        const auto next = static_cast<std::size_t>(k);
        if (next < table_.clusters().size() &&
            table_.clusters()[next] == table_.clusters()[next - 1])
          continue;
        for (std::size_t i = 0; i < 3; ++i) {
          spread[i] += of_cluster[i] * of_cluster[i], of_cluster[i] = 0;
        }
      }
      for (std::size_t i = 0; i < 3; ++i) {
        const double noise = table_.noise_of(n, i, raw.theta);
        const double takes = square[i] - noise;
        place.seen[i] = {1 + (along[i] + noise) / takes, kNormal95 * std::sqrt(spread[i]) / takes};
      }
      if (table_.motions()[n].added_mass == 0) places.push_back(place);
    }
    return places;
  }

  /// Max. difference between a mass and that of the same axis at the first pose, relative.
  double max_change(const LinkFit& fit) const {
    const auto masses = [&](std::size_t n) {
      const auto& samples = table_.motions()[n].samples;
      return masses_at(arm_, samples[samples.size() / 2].q);
    };
    const MassTerms first = masses(0);
    const auto theta = fit.theta.head<6>();
    double max_change_found = 0;
    for (std::size_t n = 1; n < table_.motions().size(); ++n) {
      const MassTerms here = masses(n) - first;
      for (int axis = 0; axis < 3; ++axis) {
        const double change = here.row(axis) * theta;
        const double variance =
            here.row(axis) * fit.covariance.topLeftCorner<6, 6>() * here.row(axis).transpose();
        const double from = first.row(axis) * theta;
        max_change_found =
            std::max(max_change_found, (std::abs(change) + kNormal95 * std::sqrt(variance)) / from);
      }
    }
    return max_change_found;
  }

  driver::SerialArm arm_;
  LinkRows table_;
};

}  // namespace

std::array<Estimate, 3> LinkFit::apparent_mass(const Eigen::Vector3d& q) const {
  const MassTerms masses = masses_at(arm, q);
  std::array<Estimate, 3> found;
  for (int axis = 0; axis < 3; ++axis) {
    const double mass = masses.row(axis) * theta.head<6>();
    const double variance =
        masses.row(axis) * covariance.topLeftCorner<6, 6>() * masses.row(axis).transpose();
    found[static_cast<std::size_t>(axis)] = {
        mass, kNormal95 * math::hypot(std::sqrt(variance), kLinkMethodMass * mass)};
  }
  return found;
}

driver::Result<LinkFit> fit_links(const driver::SerialArm& arm,
                                  const std::vector<ArmMotion>& motions) {
  return LinkSearch(arm, motions).run();
}

}  // namespace thimble::bringup
