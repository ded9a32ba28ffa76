#pragma once

#include <Eigen/Core>
#include <array>

namespace thimble::compat::haply {

// The frame of the vectors of an Inverse3's service (B: x right, y away from the user, z up [S
// docs.haply.co/inverseSDK]). It is placed in our world as in app/arms/inverse3.yaml: the middle of
// the documented targets is the world's origin.

/// The origin of B in the world, m.
inline const Eigen::Vector3d kOrigin_W{-0.130, 0, -0.170};

/// Converts a direction from W to B.
inline Eigen::Vector3d direction_B(const Eigen::Vector3d& v_W) {
  return {v_W.y(), -v_W.x(), v_W.z()};
}
/// Converts a direction from B to W.
inline Eigen::Vector3d direction_W(const Eigen::Vector3d& v_B) {
  return {-v_B.y(), v_B.x(), v_B.z()};
}
/// Converts a point from W to B, m.
inline Eigen::Vector3d point_B(const Eigen::Vector3d& p_W) {
  return direction_B(p_W - kOrigin_W);
}

/// Returns a vector of a reading.
inline Eigen::Vector3d vector_of(const std::array<double, 3>& v) {
  return Eigen::Map<const Eigen::Vector3d>(v.data());
}

}  // namespace thimble::compat::haply
