#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "collision/collider.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/motion_choice.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// What an object is touched as: a shape, or a mesh (W, m).
struct SolidToCollide {
  const TriangleMesh* mesh_W = nullptr;  ///< May be null for a shape that does not move.
  const Primitive* shape_W = nullptr;    ///< Null for a mesh.
};

/// Place of a body's frame B in W.
struct PlaceOfBody {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WB{0, 0, 0};
};

/// Returns the axes (W) of a shape that is symmetric about them; empty for a mesh or a plane.
std::optional<Eigen::Matrix3d> axes_of(const SolidToCollide& solid);

/// Returns the shapes with which an object collides, in the frame B; `body` empty: it does not
/// move, and B is W. The error states which shape cannot be made. Real-time: never from the servo
/// thread.
driver::Result<ColliderSet> collider_of(const SolidToCollide& solid, const CollisionChoice& choice,
                                        const std::optional<PlaceOfBody>& body);

}  // namespace thimble::render
