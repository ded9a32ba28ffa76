#pragma once

#include <cstddef>
#include <optional>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Surfaces of the shapes with which objects collide, for drawing. They are computed on request.
class CollisionSurfaces {
 public:
  CollisionSurfaces() = default;
  CollisionSurfaces(const CollisionSurfaces&) = delete;
  CollisionSurfaces& operator=(const CollisionSurfaces&) = delete;
  virtual ~CollisionSurfaces() = default;

  /// Returns the surface of an object (its number in the list of collide_objects) at its first
  /// place, W, m; triangles counter-clockwise from outside. Without triangles: it does not collide.
  /// Empty: it collides with its own shape or mesh. Any thread. Real-time: never from the servo
  /// thread.
  virtual std::optional<TriangleMesh> surface_W(std::size_t object) const = 0;
};

}  // namespace thimble::render
