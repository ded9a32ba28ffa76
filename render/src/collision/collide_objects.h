#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "body/motion/shared_body.h"
#include "collision/collider_of.h"
#include "collision/collision_surfaces.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/joint_choice.h"
#include "thimble/render/body/motion_choice.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// An object that collides, or that a joint holds.
struct CollidingObject {
  std::string name;      ///< For messages.
  SolidToCollide solid;  ///< What it is.
  CollisionChoice collision;
  std::optional<MotionChoice> motion;  ///< Empty: it does not move.
  BodyCoupling coupling;               ///< Of its surface, if it moves.
  /// Force laws at its first place, one for each hand; empty if it does not move.
  std::vector<std::unique_ptr<ObjectTouch>> surfaces;
};

/// A joint between two objects, by their numbers in the list; -1: the world.
struct ObjectJoint {
  JointChoice choice;
  int a = -1;
  int b = -1;
};

/// Objects that move, ready to be touched.
struct CollidingTouches {
  /// Force laws of each object that moves, in the order of the objects, one for each hand.
  std::vector<std::vector<std::unique_ptr<ObjectTouch>>> touches;
  /// The bodies. With several hands, the code that runs the loop steps them once per tick; with
  /// one, the force laws do.
  std::shared_ptr<SharedBody> bodies;
  /// The shapes that collide, for drawing.
  std::shared_ptr<const CollisionSurfaces> surfaces;
  /// Sentences about what will not move as expected: overlaps, and masses too different.
  std::vector<std::string> notes;
};

/// Makes objects that move and collide. The error names the object and the invalid number. The
/// first tick must be after all objects are built. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<CollidingTouches> collide_objects(
    std::vector<CollidingObject> objects, const std::vector<ObjectJoint>& joints,
    const CollisionQuality& quality, std::size_t hands);

}  // namespace thimble::render
