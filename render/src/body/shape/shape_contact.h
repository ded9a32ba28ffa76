#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::render {

/// What a body that changes shape knows of the press on it, in the frame of its mesh.
struct ShapeContact {
  std::int32_t triangle = -1;        ///< That is touched; -1: none.
  Eigen::Vector3d weights{0, 0, 0};  ///< Of the triangle's corners at the touched place, each >= 0.
  Eigen::Vector3d p_first{0, 0, 0};  ///< Where that place was on the first shape, m.
  Eigen::Vector3d inward{0, 0, 0};   ///< Unit, against the outward normal.
  Eigen::Vector3d first_inward{0, 0, 0};  ///< The same of the triangle as it was at first.
  double depth = 0;                       ///< m, >= 0: how far the surface's spring is pressed in.
};

}  // namespace thimble::render
