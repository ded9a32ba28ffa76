#pragma once

#include <memory>
#include <utility>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "mesh/triangle_place.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/surface/surface_response.h"
#include "track/concave_constraint.h"
#include "track/curved_depth.h"
#include "track/edge_blending.h"

namespace thimble::render {

/// Wraps a contact stage and smooths its normal and depth. A `Contact` stage of ContactForceLaw,
/// joined at compile time, as in `ContactForceLaw<Blended<MeshContact, FixedBand>, SpringDamper>`.
///
/// `Contact` is any TrackedContact. `Shading` chooses the felt normal (edge_blending.h), `Depth`
/// the felt depth (curved_depth.h). Over OffsetContact the result is continuous over smooth edges
/// and vertices at any depth. Over MeshContact it is continuous across each edge plane. Below the
/// surface, where the edge planes of a vertex overlap or leave gaps, it may jump by about depth /
/// edge length of the angle between the faces. Real-time: `update` is safe if the contact's is.
template <class Contact, class Shading, class Depth = MeshDepth>
class Blended {
 public:
  /// Takes a contact stage and computes the mesh's normals, with creases where faces meet at more
  /// than `crease_angle` (rad). Real-time: never from the servo thread.
  explicit Blended(Contact contact, Shading shading = {}, double crease_angle = kCreaseAngle)
      : Blended(std::move(contact), std::move(shading), nullptr, crease_angle) {}

  /// Takes normals already computed for the same mesh. Real-time: never from the servo thread.
  Blended(Contact contact, Shading shading, std::shared_ptr<const SmoothNormals> normals)
      : Blended(std::move(contact), std::move(shading), std::move(normals), kCreaseAngle) {}

  /// Whether a copy is cheap, as for the wrapped contact.
  static constexpr bool kCopiesCheaply = Contact::kCopiesCheaply;

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call.
  const ContactState& update(const driver::DeviceState& state) noexcept {
    state_ = contact_.update(state);
    if (!state_.touching) return state_;
    const SurfacePlace& held = contact_.held();
    if (held.triangle >= 0 && on_concave_crease(mesh(), *normals_, held)) return state_;
    const auto weights = contact_.weights(state.p_WT);
    state_.n_W = shading_.normal(mesh(), *normals_, state_.triangle, weights);
    state_.depth = depth_.depth(mesh(), *normals_, state_.triangle, weights, state_.depth);
    state_.p_WP = state.p_WT + state_.depth * state_.n_W;
    return state_;
  }

  /// Forwards that the surface has moved (TrackedContact). Real-time: safe.
  void surface_moved(std::int32_t swept_over) noexcept {
    contact_.surface_moved(swept_over);
    state_ = contact_.state();
  }
  /// Begins contact on a triangle with the proxy at `p_WP` (W, m), whatever the path of the tip:
  /// for a world of several objects (render/src/world). Real-time: safe.
  void begin(std::int32_t triangle, const Eigen::Vector3d& p_WP) noexcept {
    contact_.begin(triangle, p_WP);
    state_ = contact_.state();
  }
  /// Ends the contact, if any, and places the free tip at `p_WT` (W, m). Real-time: safe.
  void set_free(const Eigen::Vector3d& p_WT) noexcept {
    contact_.set_free(p_WT);
    state_ = contact_.state();
  }
  /// Returns the start of the free tip's path (TrackedContact). Real-time: safe.
  Eigen::Vector3d free_tip() const noexcept { return contact_.free_tip(); }

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept { return state_; }

  /// Returns the surface point of the tip at `p_WT` (W, m), with the felt normal
  /// (surface_response.h). Real-time: safe.
  ClosestSurfacePoint closest(const Eigen::Vector3d& p_WT) const noexcept {
    const SurfacePlace& held = contact_.held();
    const bool by_crease = held.triangle >= 0 && on_concave_crease(mesh(), *normals_, held);
    ClosestSurfacePoint closest;
    if (by_crease) {
      closest = contact_.closest(p_WT);
    } else if constexpr (Contact::kHasTrianglePlace) {
      const TrianglePlace place = contact_.triangle_place(p_WT);
      closest = contact_.closest_at(place);
      closest.fall_W =
          depth_.fall(mesh(), *normals_, place, contact_.state().depth, closest.fall_W);
    } else {
      closest = contact_.closest_on_triangle(p_WT);
    }
    closest.n_M = state_.n_W;
    return closest;
  }

  const Contact& contact() const noexcept { return contact_; }
  const ContactMesh& mesh() const noexcept { return contact_.mesh(); }
  const auto& search() const noexcept { return contact_.search(); }
  /// Returns the normals that are blended. Real-time: safe.
  const std::shared_ptr<const SmoothNormals>& smooth_normals() const noexcept { return normals_; }
  auto counters() const noexcept { return contact_.counters(); }

 private:
  Blended(Contact contact, Shading shading, std::shared_ptr<const SmoothNormals> normals,
          double crease_angle)
      : contact_(std::move(contact)),
        normals_(normals ? std::move(normals)
                         : std::make_shared<const SmoothNormals>(contact_.mesh(), crease_angle)),
        shading_(std::move(shading)) {}

  Contact contact_;
  std::shared_ptr<const SmoothNormals> normals_;
  Shading shading_;
  [[no_unique_address]] Depth depth_;
  ContactState state_;
};

}  // namespace thimble::render
