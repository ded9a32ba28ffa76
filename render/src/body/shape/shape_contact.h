#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::render {

/// The press on a body that changes shape, in the frame of its mesh.
struct ShapeContact {
  std::int32_t triangle = -1;             ///< The touched triangle; -1: none.
  Eigen::Vector3d weights{0, 0, 0};       ///< Corner weights of the touched place, each >= 0.
  Eigen::Vector3d p_first{0, 0, 0};       ///< The touched place on the first shape, m.
  Eigen::Vector3d inward{0, 0, 0};        ///< Unit, against the outward normal.
  Eigen::Vector3d first_inward{0, 0, 0};  ///< The same for the triangle in the first shape.
  double depth = 0;                       ///< m, >= 0: compression of the surface's spring.
};

}  // namespace thimble::render
