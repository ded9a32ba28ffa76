#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include "field/between_faces.h"
#include "field/entry_face_contact.h"
#include "field/faced_contact.h"
#include "field/primitive_contact.h"
#include "field/round_entry.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/field/box.h"
#include "thimble/render/field/half_space.h"
#include "thimble/render/field/round_shapes.h"
#include "thimble/render/field/sphere.h"
#include "thimble/render/object_touch.h"
#include "track/path_bounded.h"
#include "world_solid.h"

namespace thimble::render {
namespace shape_solid {

/// Returns where a path enters a half-space. Real-time: safe, as all of these.
inline SolidEntry first_entry(const HalfSpace& plane, const Eigen::Vector3d& p_from,
                              const Eigen::Vector3d& p_to) noexcept {
  const double from = plane.place(p_from, {}).depth, to = plane.place(p_to, {}).depth;
  // Written so that NaN enters nothing.
  if (!(from <= 0 && to > 0)) return {};
  return {.triangle = 0, .parameter = -from / (to - from)};
}

/// Returns where a path enters a sphere.
inline SolidEntry first_entry(const Sphere& sphere, const Eigen::Vector3d& p_from,
                              const Eigen::Vector3d& p_to) noexcept {
  const Eigen::Vector3d from = p_from - sphere.p_WO, way = p_to - p_from;
  const double outside = from.squaredNorm() - sphere.radius * sphere.radius;
  const double along = from.dot(way), squared = way.squaredNorm();
  if (!(outside >= 0 && along < 0)) return {};
  const double root = along * along - squared * outside;
  if (!(root > 0)) return {};
  // Without the cancellation of -along - sqrt(root).
  const double parameter = outside / (std::sqrt(root) - along);
  if (!(parameter <= 1)) return {};
  return {.triangle = 0, .parameter = parameter};
}

/// Returns where a path enters a box, by its face.
inline SolidEntry first_entry(const Box& box, const Eigen::Vector3d& p_from,
                              const Eigen::Vector3d& p_to) noexcept {
  const Eigen::Vector3d from = box.to_box(p_from), way = box.to_box(p_to) - from;
  double in = -1, out = std::numeric_limits<double>::infinity();
  std::int32_t face = -1;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double half = box.half_sides[axis];
    const bool beside = !between_faces(box, from[axis], axis);
    if (beside && !(way[axis] * from[axis] < 0)) return {};
    if (way[axis] != 0) {
      out = std::fmin(out, (std::copysign(half, way[axis]) - from[axis]) / way[axis]);
    }
    if (!beside) continue;
    const double at = (std::copysign(half, from[axis]) - from[axis]) / way[axis];
    if (!(at > in)) continue;
    in = at;
    face = 2 * static_cast<std::int32_t>(axis) + (from[axis] > 0 ? 1 : 0);
  }
  if (face < 0 || !(in <= 1 && in < out)) return {};
  return {.triangle = face, .parameter = in};
}

inline SolidBox box_of(const HalfSpace& plane) noexcept {
  return {plane.p_WO, plane.p_WO};
}
inline SolidBox box_of(const Sphere& sphere) noexcept {
  return {sphere.p_WO.array() - sphere.radius, sphere.p_WO.array() + sphere.radius};
}
inline SolidBox box_of(const Box& box) noexcept {
  // A margin for rounding.
  const Eigen::Vector3d reach = (1 + 0x1p-40) * (box.R_WO.cwiseAbs() * box.half_sides);
  return {box.p_WO - reach, box.p_WO + reach};
}

/// Returns the box of a solid of revolution that reaches `along` its axis, and `across` it at all
/// heights; `around` is added in all directions.
inline SolidBox round_box(const RoundFrame& frame, double along, double across,
                          double around) noexcept {
  const Eigen::Array3d axis_W = frame.R_WO.col(2).array();
  // A margin for rounding, also of the direction of the axis.
  const Eigen::Vector3d reach =
      (1 + 0x1p-40) *
      (along * axis_W.abs() + across * (1 - axis_W.square()).max(0x1p-40).sqrt() + around);
  return {frame.p_WO - reach, frame.p_WO + reach};
}
inline SolidBox box_of(const Cylinder& cylinder) noexcept {
  return round_box(cylinder, cylinder.half_height, cylinder.radius, 0);
}
inline SolidBox box_of(const Cone& cone) noexcept {
  return round_box(cone, cone.half_height, cone.radius, 0);
}
inline SolidBox box_of(const Capsule& capsule) noexcept {
  return round_box(capsule, capsule.half_height, 0, capsule.radius);
}
inline SolidBox box_of(const Torus& torus) noexcept {
  return round_box(torus, 0, torus.radius, torus.tube);
}

template <class Law>
struct ShapeContact : std::false_type {};
template <class Shape, class... Stages>
struct ShapeContact<ContactForceLaw<PathBounded<PrimitiveContact<Shape>>, Stages...>>
    : std::true_type {};
template <class... Stages>
struct ShapeContact<ContactForceLaw<PathBounded<EntryFaceContact>, Stages...>> : std::true_type {};
template <class Shape, class... Stages>
struct ShapeContact<ContactForceLaw<PathBounded<FacedContact<Shape>>, Stages...>> : std::true_type {
};

}  // namespace shape_solid

/// A force law of a shape without a mesh.
template <class Law>
concept ShapeLaw = shape_solid::ShapeContact<Law>::value;

/// WorldSolid over the force law of a shape without a mesh. The closest point of a plane, of a
/// rounded shape, or of the face through which the proxy entered is the proxy that it can reach.
/// The wedges of a box may change to a face inside another solid; then the plane of the last face
/// holds.
template <ShapeLaw Law>
class ShapeSolid final : public WorldSolid {
 public:
  /// Keeps a reference: the law must outlive the solid.
  explicit ShapeSolid(Law& law) noexcept : law_(law) {}

  SolidBox box() const noexcept override { return shape_solid::box_of(shape()); }
  double rounding() const noexcept override {
    const SolidBox all = box();
    return 64 * 0x1p-53 * ((all.max - all.min).norm() + (all.max + all.min).norm() / 2);
  }
  double stiffness() const noexcept override { return law_.spring_stiffness(); }
  /// A half-space has no box.
  bool moves() const noexcept override { return std::is_base_of_v<HalfSpace, Shape>; }
  bool inside(const Eigen::Vector3d& p_W) const noexcept override { return shape().inside(p_W); }
  SolidEntry first_entry(const Eigen::Vector3d& p_from,
                         const Eigen::Vector3d& p_to) noexcept override {
    return shape_solid::first_entry(shape(), p_from, p_to);
  }
  const ContactState& begin(std::int32_t face, const Eigen::Vector3d& p_WP) noexcept override {
    face_ = face;
    contact().begin(face, p_WP);
    return contact().state();
  }
  void revive(const Eigen::Vector3d& p_WP) noexcept override { contact().begin(face_, p_WP); }
  const ContactState& follow(const Eigen::Vector3d& p_W) noexcept override {
    driver::DeviceState state;
    state.p_WT = p_W;
    const ContactState& found = contact().update(state);
    if (found.touching) {
      face_ = found.triangle;
    } else if constexpr (std::is_same_v<Shape, WedgeBox>) {
      // Exactly in the plane of another face, its depth is 0; the last face still holds.
      const Eigen::Vector3d p_O = shape().to_box(p_W);
      const double depth = shape().depth(p_O, face_);
      if (holds(p_W) && depth > 0) {
        held_ = {.touching = true, .triangle = face_, .depth = depth, .n_W = shape().normal(face_)};
        held_.p_WP = p_W + depth * held_.n_W;
        return held_;
      }
    }
    return found;
  }
  bool follows_closely() const noexcept override { return !std::is_same_v<Shape, WedgeBox>; }
  const ContactState& follow_closely(const ContactState& last,
                                     const Eigen::Vector3d& p_W) noexcept override {
    held_ = last;
    held_.depth = last.n_W.dot(last.p_WP - p_W);
    held_.p_WP = p_W + held_.depth * last.n_W;
    held_.touching = held_.depth > 0 && holds(held_.p_WP - kBelow * rounding() * last.n_W);
    held_.hops = 0;
    return held_;
  }
  driver::ForceCommand feel(const driver::DeviceState& state,
                            const ContactState& felt) noexcept override {
    return law_.respond(state, felt, Held{felt});
  }
  void leave() noexcept override { law_.respond({}, {}, contact()); }

 private:
  using Contact = std::remove_cvref_t<decltype(std::declval<Law&>().contact().contact())>;
  using Shape = std::remove_cvref_t<decltype(std::declval<const Contact&>().shape())>;
  static constexpr double kBelow = 256;  // roundings

  // Source of the surface point: flat, or that of the shape.
  struct Held {
    const ContactState& contact;
    const ContactState& state() const noexcept { return contact; }
  };

  // Returns whether a point is inside, or on a face as between_faces decides.
  bool holds(const Eigen::Vector3d& p_W) const noexcept {
    if constexpr (std::is_base_of_v<Box, Shape>) {
      const Eigen::Vector3d p_O = shape().to_box(p_W);
      return between_faces(shape(), p_O[0], 0) && between_faces(shape(), p_O[1], 1) &&
             between_faces(shape(), p_O[2], 2);
    } else {
      return inside(p_W);
    }
  }

  Contact& contact() const noexcept { return law_.contact().contact(); }
  const Shape& shape() const noexcept { return contact().shape(); }

  Law& law_;
  std::int32_t face_ = 0;
  ContactState held_;  // of `follow_closely`
};

}  // namespace thimble::render
