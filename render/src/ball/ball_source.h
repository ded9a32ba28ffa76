#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ball/ball_feature.h"
#include "world_solid.h"

namespace thimble::render {

/// Maximum number of features that a step of a ball regards at once. [chosen]
inline constexpr std::size_t kFeaturesMax = 48;

/// A solid under a ball: finds its parts near the centre of the ball. W, m; Real-time: safe.
///
/// `features(q, reach)` lists half-spaces that hold q and are farther than the radius from the
/// solid in a ball around q: of the radius `reach`, which it may enlarge or, if that is not
/// possible, reduce. `feature(id, q)` is one of them, for another centre. `clear(from, to)` returns
/// whether both are known to be in a ball without contact. `first_entry` finds where the ball on a
/// path of its centre meets the solid first; none if it begins inside. `inside(q)` returns whether
/// the ball is not outside of the solid, `in_solid(q)` whether its centre is inside.
template <class Source>
concept BallSource = requires(Source& source, const Source& still, const Eigen::Vector3d& q,
                              double& reach) {
  { source.features(q, reach) }
  noexcept->std::same_as<std::span<const BallFeature>>;
  { still.feature(std::int32_t{}, q) }
  noexcept->std::same_as<BallFeature>;
  { still.clear(q, q) }
  noexcept->std::same_as<bool>;
  { source.first_entry(q, q) }
  noexcept->std::same_as<SolidEntry>;
  { still.inside(q) }
  noexcept->std::same_as<bool>;
  { still.in_solid(q) }
  noexcept->std::same_as<bool>;
  { still.box() }
  noexcept->std::same_as<SolidBox>;
  { still.radius() }
  noexcept->std::same_as<double>;
  { still.rounding() }
  noexcept->std::same_as<double>;
};

/// Place where the ball on a path meets one convex part, as a share of the path; above 1: it does
/// not. `feature(x)` is the part's feature for the centre x. The distance from a convex part is a
/// convex function along the path, so Newton's steps from outside pass nothing. A ball no farther
/// than `tolerance` (m) touches the part; the path must lead deeper than that. Real-time: safe.
template <class Feature>
double meets_convex(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double tolerance,
                    double share_max, const Feature& feature) noexcept {
  constexpr double kNever = 2;
  // A path that grazes the part takes some 25 steps: halves of the distance from where it is
  // nearest.
  constexpr int kStepsMax = 60;
  const Eigen::Vector3d way = to - from;
  double share = 0;
  for (int step = 0; step < kStepsMax; ++step) {
    const BallFeature near = feature(Eigen::Vector3d(from + share * way));
    const double approach = -near.n_W.dot(way);
    // Written so that NaN meets nothing.
    if (!(approach > 0)) return kNever;
    if (near.gap <= tolerance) {
      // A ball that ends on the part, by rounding, is not held by it.
      return approach * (1 - share) - near.gap > tolerance / 2 ? share : kNever;
    }
    share += near.gap / approach;
    if (!(share <= share_max)) return kNever;
  }
  return share;
}

}  // namespace thimble::render
