#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "thimble/driver/device_state.h"
#include "thimble/driver/export.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/field/box.h"

namespace thimble::render {

/// Finds the contact on a box whose force depends on the path: the face through which the tip
/// entered pushes it back, at any depth [BP Fig. 2a]. A `Contact` stage of ContactForceLaw.
///
/// The face is found on the straight path since the last tick, at any speed. It holds the tip while
/// the tip is below the face's plane and within its outline. This includes the space beyond the
/// back of a thin plate, so the tip cannot pop through. Contact ends above the plane, or where the
/// tip leaves sideways. So a tip that comes out of another face is released at once, without a
/// pull.
class THIMBLE_EXPORT EntryFaceContact {
 public:
  explicit EntryFaceContact(const Box& box) : box_(box) {}

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call.
  ///
  /// A path that ends inside has entered. One that goes in and out again within the tick counts if
  /// it ends behind the face through which it entered. At an edge or a corner, the face that the
  /// path meets most squarely is chosen. A tip that is inside on the first tick touches nothing
  /// until it has been outside. A position that is NaN or beyond `kPositionMax` ends the contact
  /// and makes the next tick a first one. Real-time: safe; a few ns.
  const ContactState& update(const driver::DeviceState& state) noexcept;

  /// Begins contact on a face, whatever the path of the tip: for a world of several objects
  /// (render/src/world). Real-time: safe.
  void begin(std::int32_t face, const Eigen::Vector3d& p_WP) noexcept {
    has_before_ = true;
    p_O_before_ = box_.to_box(p_WP);
    state_ = {.touching = true, .triangle = face, .n_W = box_.normal(face), .p_WP = p_WP};
  }

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept { return state_; }

  const Box& shape() const noexcept { return box_; }
  /// Returns an object with `inside`, like the searches of meshes. Real-time: safe.
  const Box& search() const noexcept { return box_; }

 private:
  bool behind(const Eigen::Vector3d& p_O, std::int32_t face) const noexcept;
  std::int32_t entry(const Eigen::Vector3d& from_O, const Eigen::Vector3d& to_O) const noexcept;

  Box box_;
  ContactState state_;
  Eigen::Vector3d p_O_before_{0, 0, 0};
  bool has_before_ = false;
};

}  // namespace thimble::render
