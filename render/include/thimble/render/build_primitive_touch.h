#pragma once

#include <memory>
#include <variant>

#include "thimble/driver/export.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/field/box.h"
#include "thimble/render/field/half_space.h"
#include "thimble/render/field/round_shapes.h"
#include "thimble/render/field/sphere.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Box whose force depends on the face through which the tip entered (EntryFaceContact).
struct EntryFaceBox : Box {};

/// Any shape without a mesh.
using Primitive =
    std::variant<HalfSpace, Sphere, WedgeBox, EntryFaceBox, Cylinder, Cone, Capsule, Torus>;

/// Builds the force law of one shape (W, m) from only the stages that `surface` names. The caller
/// provides unit normals and sizes above 0. `tip_radius` (m) is that of a tip that is a ball; 0: a
/// point. Under a ball, both kinds of box are the same. Real-time: never from the servo thread.
THIMBLE_EXPORT std::unique_ptr<ObjectTouch> build_primitive_touch(const Primitive& shape_W,
                                                                  const SurfaceChoice& surface,
                                                                  double tip_radius = 0);

}  // namespace thimble::render
