#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "collision/collider_of.h"
#include "collision/collision_surfaces.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Shapes of an object, and the place of their frame.
struct PlacedColliders {
  ColliderSet set;
  PlaceOfBody place;
  bool own = false;  ///< They are the shape or the mesh that is touched.
};

/// Returns the surface of shapes, W, m: of a half-space nothing, of triangles themselves, of all
/// others convex polyhedra, round ones with corners on the exact shape. Real-time: never from the
/// servo thread.
TriangleMesh collider_surface(const ColliderSet& set, const PlaceOfBody& place);

/// Returns whether shapes are those that are touched, as they are drawn already.
bool collides_as_touched(const SolidToCollide& solid, const CollisionChoice& choice,
                         const ColliderSet& set);

/// Returns the surfaces of objects. Real-time: never from the servo thread.
std::shared_ptr<const CollisionSurfaces> collision_surfaces(std::vector<PlacedColliders> objects);

}  // namespace thimble::render
