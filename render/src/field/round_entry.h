#pragma once

#include <Eigen/Core>

#include "thimble/driver/export.h"
#include "thimble/render/field/round_shapes.h"
#include "world_solid.h"

namespace thimble::render::shape_solid {

// Where a straight path (W, m) first enters a shape from outside; `triangle` is the number of the
// face. A path that begins outside and ends inside always enters. Real-time: safe; up to 1 us for
// the torus, tens of ns for the others.

/// Closed form.
THIMBLE_EXPORT SolidEntry first_entry(const Cylinder& cylinder, const Eigen::Vector3d& p_from,
                                      const Eigen::Vector3d& p_to) noexcept;
/// Closed form.
THIMBLE_EXPORT SolidEntry first_entry(const Cone& cone, const Eigen::Vector3d& p_from,
                                      const Eigen::Vector3d& p_to) noexcept;
/// Closed form.
THIMBLE_EXPORT SolidEntry first_entry(const Capsule& capsule, const Eigen::Vector3d& p_from,
                                      const Eigen::Vector3d& p_to) noexcept;
/// The extrema of the quartic divide the path into pieces that cross the surface at most once; the
/// first piece that enters is bisected.
THIMBLE_EXPORT SolidEntry first_entry(const Torus& torus, const Eigen::Vector3d& p_from,
                                      const Eigen::Vector3d& p_to) noexcept;

}  // namespace thimble::render::shape_solid
