#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Mass properties of a body: C is its centre of mass, B its frame, with its origin in C and its
/// axes along the principal ones.
struct MassProperties {
  double mass = 1;                                           ///< kg, > 0
  Eigen::Vector3d p_WC{0, 0, 0};                             ///< m
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();  ///< Turns vectors from B to W.
  Eigen::Vector3d inertia{1, 1, 1};  ///< kg m^2 about the axes of B, > 0, smallest first
  double volume = 0;                 ///< m^3

  /// Returns whether these numbers are physically possible: all finite and positive, and no inertia
  /// larger than the sum of the other two.
  bool valid() const noexcept;
};

/// Computes the mass properties of the matter inside a closed mesh (W, m) of `mass` kg, of uniform
/// density: exact for the polyhedron, a sum over its triangles. The error states that the mass is
/// not positive or that the mesh encloses no volume (open, flat or inside out). Real-time: never
/// from the servo thread.
THIMBLE_EXPORT driver::Result<MassProperties> mass_properties(const TriangleMesh& mesh,
                                                              double mass);

/// Turns B to axes of a symmetric shape (a rotation to W), in the order of their inertia, if these
/// are principal axes up to 1e-9. Only where several axes are equally good does B change by more
/// than signs and order. Real-time: never from the servo thread.
THIMBLE_EXPORT void prefer_axes(const Eigen::Matrix3d& axes_W, MassProperties& properties);

}  // namespace thimble::render
