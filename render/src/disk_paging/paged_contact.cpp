#include "disk_paging/paged_contact.h"

#include <algorithm>
#include <cmath>

#include "track/packed_contact_steps.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Growth of the depth allowed per metre that the tip slides sideways: the felt normal leans against
// the surface by some degrees where triangles are coarse.
constexpr double kSideways = 0.5;

}  // namespace

template class PackedContact<PagedStore>;

PagedContact::PagedContact(std::shared_ptr<PagedSurface> surface, const PagedPlace& place)
    : contact_(PagedStore(std::move(surface))), place_(place), per_scale_(1 / place.scale) {}

const ContactState& PagedContact::update(const driver::DeviceState& state) noexcept {
  driver::DeviceState in_mesh_state = state;
  in_mesh_state.p_WT = in_mesh(state.p_WT);
  in_mesh_state.v_WT = place_.R_WM.transpose() * state.v_WT * per_scale_;
  // The place touched by a pressed tip is away from it, and so may be the path still to be
  // examined.
  const Vector3d p_place = state_.touching ? in_mesh(state_.p_WP + (state.p_WT - p_WT_before_))
                           : has_before_   ? contact_.path_begin()
                                           : in_mesh_state.p_WT;
  PagedSurface& pages = surface();
  pages.begin_tick(in_mesh_state.p_WT, p_place, in_mesh_state.v_WT);
  ContactState now = contact_.update(in_mesh_state);
  pages.end_tick();
  pages.note_misses(contact_.ticks_held());
  if (now.touching) {
    now.n_W = place_.R_WM * now.n_W;
    // Written so that NaN is kept and means no force.
    const double allowed = allowed_depth(state, now.n_W);
    now.depth = place_.scale * now.depth;
    if (now.depth > allowed) now.depth = allowed;
    now.p_WP = state.p_WT + now.depth * now.n_W;
  }
  state_ = now;
  p_WT_before_ = state.p_WT;
  has_before_ = true;
  return state_;
}

ClosestSurfacePoint PagedContact::closest(const Vector3d& p_WT) const noexcept {
  const Vector3d p_MT = in_mesh(p_WT);
  ClosestSurfacePoint closest = contact_.closest(p_MT);
  closest.p_M = p_WT + place_.scale * (place_.R_WM * (closest.p_M - p_MT));
  closest.n_M = state_.n_W;
  closest.J_MT = place_.R_WM * closest.J_MT * place_.R_WM.transpose();
  closest.fall_W = place_.R_WM * closest.fall_W;
  return closest;
}

// Returns the maximum depth of the tip if the surface had been entered normally.
double PagedContact::allowed_depth(const driver::DeviceState& state,
                                   const Vector3d& n_W) const noexcept {
  if (!has_before_) return 0;
  const Vector3d moved = state.p_WT - p_WT_before_;
  const double sunk = -n_W.dot(moved);
  const double slid = std::sqrt(std::max(moved.squaredNorm() - sunk * sunk, 0.0));
  const double before = state_.touching ? state_.depth : 0.0;
  return std::max(before + sunk, 0.0) + kSideways * slid + kRiseSpeed * state.dt;
}

bool PagedContact::Search::inside(const Vector3d& p_W) const {
  return contact_.surface().inside_by_reading(contact_.in_mesh(p_W));
}

}  // namespace thimble::render
