#include "thimble/render/build_primitive_touch.h"

#include <type_traits>

#include "build_surface_touch.h"
#include "field/entry_face_contact.h"
#include "field/faced_contact.h"
#include "field/primitive_contact.h"

namespace thimble::render {

std::unique_ptr<ObjectTouch> build_primitive_touch(const Primitive& shape_W,
                                                   const SurfaceChoice& surface) {
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
