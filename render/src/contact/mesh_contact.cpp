#include "thimble/render/contact/mesh_contact.h"

#include <cmath>
#include <utility>

namespace thimble::render {

MeshContact::MeshContact(ContactMesh mesh)
    : mesh_(std::make_shared<const ContactMesh>(std::move(mesh))),
      search_(std::make_shared<const LinearSearch>(*mesh_)),
      tracker_(*mesh_, *search_) {}

driver::Result<MeshContact> MeshContact::build(const TriangleMesh& mesh,
                                               const ContactMeshOptions& options) {
  auto prepared = ContactMesh::build(mesh, options);
  if (!prepared) return prepared.error();
  return MeshContact(std::move(prepared).value());
}

const ContactState& MeshContact::update(const driver::DeviceState& state) noexcept {
  const Eigen::Vector3d& p_WT = state.p_WT;
  // Written so that NaN is out of range.
  const bool in_range = std::abs(p_WT.x()) <= kPositionMax && std::abs(p_WT.y()) <= kPositionMax &&
                        std::abs(p_WT.z()) <= kPositionMax;
  if (!in_range) {
    state_ = {};
    has_before_ = false;
    return state_;
  }
  bool follow = state_.touching;
  if (!follow && has_before_) {
    const Entry entry = search_->first_entry(p_WT_before_, p_WT);
    follow = entry.triangle >= 0;
    if (follow) tracker_.start(entry.triangle);
  }
  p_WT_before_ = p_WT;
  has_before_ = true;
  if (!follow) {
    state_ = {};
    return state_;
  }
  const TrackerStep step = tracker_.follow(p_WT);
  if (!step.touching) {
    state_ = {};
    state_.hops = step.hops;
    return state_;
  }
  state_.touching = true;
  state_.triangle = tracker_.active();
  state_.depth = step.depth;
  state_.n_W = mesh_->cell(tracker_.active()).face.n;
  state_.p_WP = p_WT + step.depth * state_.n_W;
  state_.hops = step.hops;
  return state_;
}

}  // namespace thimble::render
