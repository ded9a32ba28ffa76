#pragma once

#include <Eigen/Core>

namespace thimble::render {

/// The frame B of a mesh.
struct BodyFrame {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Turns vectors from B to W.
  Eigen::Vector3d p_WB{0, 0, 0};                       ///< Its origin, m.
};

}  // namespace thimble::render
