#include "mesh/fitted_normal.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>

#include "math/elementary.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Five coefficients: one point more than that, so that no single point decides.
constexpr std::size_t kPointsMin = 6;

// Below this share of the largest pivot the points are too close to a conic through the vertex for
// a meaningful paraboloid. Its square root is the magnification of the points' noise.
constexpr double kPivotMin = 1e-4;

// tan of the angle between guess and fit above which the surface is not a graph over the guess:
// half of the default crease angle.
constexpr double kLeanMax = 0.5774;

}  // namespace

Vector3d fitted_normal(const Vector3d& vertex, std::span<const Vector3d> around,
                       const Vector3d& about) noexcept {
  if (around.size() < kPointsMin) return about;
  const Vector3d axis_u = about.unitOrthogonal();
  const Vector3d axis_v = about.cross(axis_u);
  double size = 0;
  for (const Vector3d& p : around) size += (p - vertex).norm();
  size /= static_cast<double>(around.size());
  if (!(size > 0)) return about;
  using Coefficients = Eigen::Matrix<double, 5, 1>;
  Eigen::Matrix<double, 5, 5> squares = Eigen::Matrix<double, 5, 5>::Zero();
  Coefficients right = Coefficients::Zero();
  for (const Vector3d& p : around) {
    const Vector3d way = (p - vertex) / size;
    const double u = axis_u.dot(way);
    const double v = axis_v.dot(way);
    Coefficients row;
    row << u, v, u * u, u * v, v * v;
    // The error of the paraboloid grows with the third power of the distance.
    const double distance = way.norm();
    if (!(distance > 0)) return about;
    const double weight = 1 / (distance * distance * distance * distance);
    squares += weight * row * row.transpose();
    right += weight * about.dot(way) * row;
  }
  const Eigen::LDLT<Eigen::Matrix<double, 5, 5>> solver(squares);
  const auto pivots = solver.vectorD();
  if (!(pivots.minCoeff() > kPivotMin * pivots.maxCoeff())) return about;
  const Coefficients fit = solver.solve(right);
  if (!(math::hypot(fit[0], fit[1]) <= kLeanMax)) return about;
  return (about - fit[0] * axis_u - fit[1] * axis_v).normalized();
}

}  // namespace thimble::render
