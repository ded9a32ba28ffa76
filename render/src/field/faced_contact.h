#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "field/round_entry.h"
#include "mesh/position_range.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// Finds the contact on a cylinder or a cone, whose faces meet at sharp rims. A `Contact` stage of
/// ContactForceLaw, with the law of EntryFaceContact: the face through which the tip entered holds
/// it, at any depth, as long as the closest point of the face is within its rims. So the tip cannot
/// pop through a flat one. Within a face that is curved, the proxy follows the tip around the axis.
/// A proxy that a god-object would move over a rim is always released there, because the tip is
/// then outside.
template <class Shape>
class FacedContact {
 public:
  explicit FacedContact(const Shape& shape) : shape_(shape) {}

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call. The rules are those
  /// of EntryFaceContact::update. Real-time: safe; tens of ns.
  const ContactState& update(const driver::DeviceState& state) noexcept {
    const Eigen::Vector3d& p_WT = state.p_WT;
    if (!within_range(p_WT)) {
      state_ = {};
      has_before_ = false;
      return state_;
    }
    std::int32_t face = -1;
    if (state_.touching) {
      face = state_.triangle;
    } else if (has_before_) {
      face = shape_solid::first_entry(shape_, p_WT_before_, p_WT).triangle;
    }
    p_WT_before_ = p_WT;
    has_before_ = true;
    const PrimitivePlace place =
        face >= 0 ? shape_.on_face(p_WT, face, state_.n_W) : PrimitivePlace{};
    state_ = {};
    if (!(place.depth > 0)) return state_;
    state_.touching = true;
    state_.triangle = face;
    state_.depth = place.depth;
    state_.n_W = place.n_W;
    state_.p_WP = p_WT + place.depth * place.n_W;
    return state_;
  }

  /// Begins contact on a face, whatever the path of the tip: for a world of several objects
  /// (render/src/world). Real-time: safe.
  void begin(std::int32_t face, const Eigen::Vector3d& p_WP) noexcept {
    has_before_ = true;
    p_WT_before_ = p_WP;
    const Eigen::Vector3d n_W = shape_.on_face(p_WP, face, state_.n_W).n_W;
    state_ = {.touching = true, .triangle = face, .n_W = n_W, .p_WP = p_WP};
  }

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept { return state_; }

  /// Returns the surface point below the tip at `p_WT` (W, m) and its derivative
  /// (surface_response.h). Precondition: the last `update` was there and touches. Real-time: safe.
  ClosestSurfacePoint closest(const Eigen::Vector3d& p_WT) const noexcept {
    ClosestSurfacePoint closest = flat_closest_point(state_);
    closest.J_MT = shape_.derivative(
        p_WT, {.depth = state_.depth, .n_W = state_.n_W, .face = state_.triangle});
    return closest;
  }

  const Shape& shape() const noexcept { return shape_; }
  /// Returns an object with `inside`, like the searches of meshes. Real-time: safe.
  const Shape& search() const noexcept { return shape_; }

 private:
  Shape shape_;
  ContactState state_;
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  bool has_before_ = false;
};

}  // namespace thimble::render
