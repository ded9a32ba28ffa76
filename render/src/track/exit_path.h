#pragma once

#include <Eigen/Core>

#include "mesh/contact_mesh.h"
#include "track/surface_descent.h"

namespace thimble::render {

/// Direction and distance from a surface point to the outside.
struct ExitPath {
  Eigen::Vector3d n_O{0, 0, 0};  ///< Unit direction away from all faces at the point.
  double length = 0;             ///< Distance along it to be outside, m.
  bool from_face = false;        ///< True if it is the normal of the only face there.
  bool sure = false;             ///< False if no direction leads away from all faces.
};

/// Finds the step from a rest to just outside. It is the smallest (within a factor of 2) that leads
/// away from every face at the point by at least a quarter of the mesh's rounding. So the rounded
/// proxy is still outside. In a notch it is longer than on a face by one over the sine of half the
/// notch's angle. Not sure below 0.5 degrees, and at vertices where no direction leads away from
/// all faces. Real-time: safe; one triangle inside a face, else those at the point.
ExitPath exit_path(const ContactMesh& mesh, const Rest& rest) noexcept;

}  // namespace thimble::render
