#pragma once

#include <Eigen/Core>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <utility>

#include "mesh/position_range.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/field/primitive_place.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// A solid whose force depends only on the position of the tip [BP 2]: a plane, a sphere, a
/// capsule, a torus, a box in wedges. `n_before_W` is the last felt normal (zero if none), for
/// positions without a unique normal.
template <class Shape>
concept PrimitiveShape = requires(const Shape& shape, const Eigen::Vector3d& p_W,
                                  const Eigen::Vector3d& n_before_W) {
  { shape.place(p_W, n_before_W) }
  noexcept->std::same_as<PrimitivePlace>;
  { shape.inside(p_W) }
  noexcept->std::same_as<bool>;
};

/// Finds the contact on an analytic shape: a `Contact` stage of ContactForceLaw, used instead of
/// MeshContact, so that all textures and frictions work on it. `ContactState::triangle` is the
/// number of the face.
///
/// Such a shape has no memory: a tip that passes through a thin one feels the far side
/// [BP 2, "thin objects can be unintentionally penetrated"]. EntryFaceContact does not have this
/// flaw.
template <PrimitiveShape Shape>
class PrimitiveContact {
 public:
  explicit PrimitiveContact(Shape shape) : shape_(std::move(shape)) {}

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call.
  ///
  /// A tip that is inside on the first tick touches nothing until it has been outside; otherwise it
  /// would be thrown out. A position that is NaN or beyond `kPositionMax` ends the contact and
  /// makes the next tick a first one. Real-time: safe; a few ns.
  const ContactState& update(const driver::DeviceState& state) noexcept {
    const Eigen::Vector3d& p_WT = state.p_WT;
    if (!within_range(p_WT)) {
      state_ = {};
      was_outside_ = false;
      return state_;
    }
    const PrimitivePlace place = shape_.place(p_WT, state_.n_W);
    const bool outside = !(place.depth > 0);
    was_outside_ = was_outside_ || outside;
    if (outside || !was_outside_) {
      state_ = {};
      return state_;
    }
    state_.hops = state_.touching && state_.triangle != place.face ? 1 : 0;
    state_.touching = true;
    state_.triangle = place.face;
    state_.depth = place.depth;
    state_.n_W = place.n_W;
    state_.p_WP = p_WT + place.depth * place.n_W;
    return state_;
  }

  /// Begins contact on a face, whatever the path of the tip: for a world of several objects
  /// (render/src/world). Real-time: safe.
  void begin(std::int32_t face, const Eigen::Vector3d& p_WP) noexcept {
    was_outside_ = true;
    state_ = {.touching = true, .triangle = face, .p_WP = p_WP};
    state_.n_W = shape_.place(p_WP, state_.n_W).n_W;
    if constexpr (requires { shape_.normal(face); }) state_.n_W = shape_.normal(face);
  }

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept { return state_; }

  /// Returns the surface point below the tip and its derivative by the tip (surface_response.h).
  /// Precondition: the last `update` touches. Real-time: safe.
  ClosestSurfacePoint closest(const Eigen::Vector3d& p_WT) const noexcept {
    ClosestSurfacePoint closest = flat_closest_point(state_);
    if constexpr (requires { shape_.tip_radius; }) {
      // The proxy is the centre of a ball.
      closest.p_M -= shape_.tip_radius * state_.n_W;
    }
    if constexpr (requires { shape_.derivative(p_WT, PrimitivePlace{}); }) {
      closest.J_MT = shape_.derivative(
          p_WT, {.depth = state_.depth, .n_W = state_.n_W, .face = state_.triangle});
    } else if constexpr (requires { shape_.stretch(state_.depth); }) {
      const double stretch = shape_.stretch(state_.depth);
      // At a centre no surface point is the closest.
      closest.J_MT *= std::isfinite(stretch) ? stretch : 0;
    }
    return closest;
  }

  const Shape& shape() const noexcept { return shape_; }
  /// Returns an object with `inside`, like the searches of meshes. Real-time: safe.
  const Shape& search() const noexcept { return shape_; }

 private:
  Shape shape_;
  ContactState state_;
  bool was_outside_ = false;
};

}  // namespace thimble::render
