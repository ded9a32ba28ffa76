#pragma once

#include <Eigen/Core>

namespace thimble::render {

/// Place of a tip in an offset triangle.
struct OffsetPlace {
  double l0 = 0, l1 = 0, l2 = 0;  ///< Weights; negative: outside the edge opposite that corner.
  double depth = 0;               ///< d, in steps of the lattice.
  bool valid = false;             ///< False if the offset triangle is turned over.
};

/// The way from a tip p to its point q on the triangle.
struct PathToSurface {
  Eigen::Vector3d to_surface{0, 0, 0};          ///< q - p, in steps of the lattice.
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();  ///< Derivative of q by p.
  Eigen::Vector3d fall{0, 0, 0};                ///< Minus the gradient in p of the felt depth.
};

/// The felt contact at a place of an offset triangle.
struct OffsetResponse {
  Eigen::Vector3d n_W{0, 0, 0};  ///< Outward unit normal.
  double depth = 0;              ///< Below the smooth surface along n_W, in steps of the lattice.
};

}  // namespace thimble::render
