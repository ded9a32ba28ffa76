#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>

#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/surface/surface_response.h"
#include "track/proxy_filter.h"

namespace thimble::render {

/// A stage says that a copy of it costs a few pointers.
template <class Contact>
concept CopiesCheaply = Contact::kCopiesCheaply;

/// A `Contact` stage of Touch around another one, of any kind: what is felt changes by no more than
/// the tip's path implies, at any depth (proxy_filter.h). Depth, normal and proxy are those that
/// are felt; triangle and hops are those that were found.
///
/// Contact begins and ends with the stage inside. It begins without a step of the force, however
/// deep it is found; where it ends the force is zero at once.
template <class Contact>
class PathBounded {
 public:
  explicit PathBounded(Contact contact) : contact_(std::move(contact)) {}

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call.
  /// Real-time: safe if the stage inside is; some ns more.
  const ContactState& update(const driver::DeviceState& state) noexcept {
    const ContactState& found = contact_.update(state);
    as_found_ = anchor_.follow(state.p_WT, found);
    return as_found_ ? found : anchor_.felt();
  }

  /// Asks a copy of the stage inside where the tip is expected: the tick then finds in the cache
  /// what it needs, code as well, and nothing has changed (ForceLaw::prepare). Only for stages of
  /// which a copy costs a few pointers (kCopiesCheaply). Real-time: safe.
  void prepare(const driver::DeviceState& expected) const noexcept requires CopiesCheaply<Contact> {
    Contact guess = contact_;
    const ContactState* found = &guess.update(expected);
    // Whoever compiles this may not leave out what nobody reads.
    asm volatile("" : : "r"(found) : "memory");
  }

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept {
    return as_found_ ? contact_.state() : anchor_.felt();
  }

  /// Passes on that the surface has moved, and which triangle has swept over the free tip
  /// (TrackedContact). `path` is how far a vertex near the tip has moved, m. Real-time: safe.
  void surface_moved(std::int32_t swept_over, double path) noexcept {
    contact_.surface_moved(swept_over);
    anchor_.surface_moved(path);
  }
  /// Returns where the free tip is examined from (TrackedContact). Real-time: safe.
  Eigen::Vector3d free_tip() const noexcept { return contact_.free_tip(); }

  /// Returns the place that was found for the tip at `p_WT` (W, m; surface_response.h). While what
  /// is felt lags behind, its depth falls along its own normal. Real-time: safe.
  SurfaceFoot foot(const Eigen::Vector3d& p_WT) const noexcept {
    SurfaceFoot foot = foot_of(contact_, p_WT);
    if (!as_found_) foot.fall_W = anchor_.felt().n_W;
    return foot;
  }

  const Contact& contact() const noexcept { return contact_; }
  const ProxyFilter& anchor() const noexcept { return anchor_; }
  decltype(auto) search() const noexcept { return contact_.search(); }
  decltype(auto) mesh() const noexcept requires requires(const Contact& contact) { contact.mesh(); }
  { return contact_.mesh(); }

 private:
  Contact contact_;
  ProxyFilter anchor_;
  bool as_found_ = true;
};

}  // namespace thimble::render
