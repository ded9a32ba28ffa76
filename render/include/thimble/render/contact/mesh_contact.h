#pragma once

#include <Eigen/Core>
#include <memory>

#include "thimble/driver/device_state.h"
#include "thimble/driver/result.h"
#include "thimble/render/contact/contact_mesh.h"
#include "thimble/render/contact/contact_state.h"
#include "thimble/render/contact/linear_search.h"
#include "thimble/render/contact/surface_tracker.h"

namespace thimble::render {

/// Finds what the tip touches on one mesh: a search along the tip's path while it is free, tracking
/// over the surface while it touches [BP 3.1]. The `Contact` stage of Touch.
class MeshContact {
 public:
  /// Takes a prepared mesh. Real-time: never from the servo thread.
  explicit MeshContact(ContactMesh mesh);

  /// Prepares a mesh (W, m); the error is that of ContactMesh::build.
  /// Real-time: never from the servo thread.
  static driver::Result<MeshContact> build(const TriangleMesh& mesh,
                                           const ContactMeshOptions& options = {});

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call.
  ///
  /// Contact begins when the path since the last tick enters the mesh, however fast, and the
  /// tracker runs in the same tick. A tip that is inside on the first tick touches nothing until it
  /// has been outside: it would be thrown out otherwise. A position that is NaN or beyond
  /// `kPositionMax` ends the contact and makes the next tick a first one. In the tick that ends a
  /// contact no new one begins, unless the tip is inside. Real-time: safe; a few ns in contact, one
  /// pass over the mesh while free or when contact ends.
  const ContactState& update(const driver::DeviceState& state) noexcept;

  /// Gives the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept { return state_; }

  const TrackerCounters& counters() const noexcept { return tracker_.counters(); }
  const ContactMesh& mesh() const noexcept { return *mesh_; }
  const LinearSearch& search() const noexcept { return *search_; }

 private:
  // On the heap, so that search and tracker keep pointing at them when the contact moves.
  std::shared_ptr<const ContactMesh> mesh_;
  std::shared_ptr<const LinearSearch> search_;
  SurfaceTracker tracker_;
  ContactState state_;
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  bool has_before_ = false;
};

}  // namespace thimble::render
