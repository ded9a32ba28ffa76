#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "math/elementary.h"

namespace thimble::render {

/// Returns the rotation by |turn_W| rad about the axis of turn_W. Real-time: safe.
inline Eigen::Quaterniond turn_by(const Eigen::Vector3d& turn_W) noexcept {
  const double half = turn_W.norm() / 2;
  if (!(half > 0)) return Eigen::Quaterniond::Identity();
  const auto [sine, cosine] = math::sin_cos(half);
  const Eigen::Vector3d axis = sine / (2 * half) * turn_W;
  return {cosine, axis.x(), axis.y(), axis.z()};
}

/// Returns the shortest rotation that leads from one orientation to another, as for turn_by.
/// Real-time: safe.
inline Eigen::Vector3d turn_between(const Eigen::Quaterniond& from,
                                    const Eigen::Quaterniond& to) noexcept {
  Eigen::Quaterniond turn = to * from.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  if (!(sine > 0)) return Eigen::Vector3d::Zero();
  return 2 * math::atan2(sine, turn.w()) / sine * turn.vec();
}

}  // namespace thimble::render
