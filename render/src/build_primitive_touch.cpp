#include "thimble/render/build_primitive_touch.h"

#include <type_traits>

#include "ball/ball_contact.h"
#include "ball/box_ball.h"
#include "ball/round_ball.h"
#include "build_surface_touch.h"
#include "field/ball_shapes.h"
#include "field/entry_face_contact.h"
#include "field/faced_contact.h"
#include "field/primitive_contact.h"

namespace thimble::render {

namespace {

std::unique_ptr<ObjectTouch> touch_with_ball(const Primitive& shape_W, const SurfaceChoice& surface,
                                             double radius) {
  return std::visit(
      [&](const auto& shape) {
        using Shape = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Shape, HalfSpace>) {
          return build_surface_touch(PrimitiveContact(BallHalfSpace(shape, radius)), surface);
        } else if constexpr (std::is_same_v<Shape, Sphere>) {
          return build_surface_touch(PrimitiveContact(BallSphere(shape, radius)), surface);
        } else if constexpr (std::is_same_v<Shape, Capsule>) {
          return build_surface_touch(PrimitiveContact(BallCapsule(shape, radius)), surface);
        } else if constexpr (std::is_same_v<Shape, Torus>) {
          return build_surface_touch(PrimitiveContact(BallTorus(shape, radius)), surface);
        } else if constexpr (std::is_same_v<Shape, Cylinder> || std::is_same_v<Shape, Cone>) {
          return build_surface_touch(BallContact(RoundBall<Shape>(shape, radius)), surface);
        } else {
          return build_surface_touch(BallContact(BoxBall(shape, radius)), surface);
        }
      },
      shape_W);
}

}  // namespace

std::unique_ptr<ObjectTouch> build_primitive_touch(const Primitive& shape_W,
                                                   const SurfaceChoice& surface,
                                                   double tip_radius) {
  if (tip_radius > 0) return touch_with_ball(shape_W, surface, tip_radius);
  return std::visit(
      [&surface](const auto& shape) {
        using Shape = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Shape, EntryFaceBox>) {
          return build_surface_touch(EntryFaceContact(shape), surface);
        } else if constexpr (std::is_same_v<Shape, Cylinder> || std::is_same_v<Shape, Cone>) {
          return build_surface_touch(FacedContact<Shape>(shape), surface);
        } else {
          return build_surface_touch(PrimitiveContact<Shape>(shape), surface);
        }
      },
      shape_W);
}

}  // namespace thimble::render
