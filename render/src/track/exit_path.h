#pragma once

#include <Eigen/Core>

#include "mesh/contact_mesh.h"
#include "track/surface_descent.h"

namespace thimble::render {

/// Where the outside is, as seen from a point of the surface.
struct ExitPath {
  Eigen::Vector3d n_O{0, 0, 0};  ///< Unit direction away from all faces around.
  double length = 0;             ///< How far to go along it to be outside, m.
  bool from_face = false;        ///< True where it is the normal of the only face around.
  bool sure = false;             ///< False where no direction leads away from all of them.
};

/// Finds the step from a rest to just outside: the smallest one (within a factor of 2) that leads
/// away from every face that meets there by at least a quarter of the mesh's rounding, so that the
/// proxy, once rounded, is still outside. In a notch it is longer than on a face by one over the
/// sine of half the notch's angle. Not sure below 0.5 degrees, and at vertices that no direction
/// sees all faces of from outside. Real-time: safe; one triangle inside a face, else those around.
ExitPath way_out(const ContactMesh& mesh, const Rest& rest) noexcept;

}  // namespace thimble::render
