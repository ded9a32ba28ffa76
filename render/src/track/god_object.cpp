#include "track/god_object.h"

#include <cmath>
#include <limits>
#include <utility>

#include "track/concave_constraint.h"
#include "track/exit_path.h"
#include "track/surface_descent.h"

namespace thimble::render {
using Eigen::Vector3d;

GodObjectContact::GodObjectContact(ContactMesh mesh, std::optional<SearchChoice> search)
    : mesh_(std::make_shared<const ContactMesh>(std::move(mesh))),
      search_(make_search(*mesh_, search)) {}

driver::Result<GodObjectContact> GodObjectContact::build(const TriangleMesh& mesh,
                                                         const ContactMeshOptions& options,
                                                         std::optional<SearchChoice> search) {
  auto prepared = ContactMesh::build(mesh, options);
  if (!prepared) return prepared.error();
  return GodObjectContact(std::move(prepared).value(), search);
}

const ContactState& GodObjectContact::update(const driver::DeviceState& state) noexcept {
  const Vector3d p_OT = state.p_WT;
  if (!within_range(p_OT)) {
    state_ = {};
    has_before_ = false;
    return state_;
  }
  if (!state_.touching) {
    place_ = {};
    if (has_before_) {
      place_.triangle = free_space_.first_entry(*search_, p_OP_, p_OT).triangle;
    }
  }
  has_before_ = true;
  state_ = {};
  if (place_.triangle >= 0) follow(p_OT);
  if (!state_.touching) p_OP_ = p_OT;
  return state_;
}

ClosestSurfacePoint GodObjectContact::closest(const Vector3d&) const noexcept {
  return resting_closest_point(*mesh_, place_, state_);
}

void GodObjectContact::follow(const Vector3d& p_OT) noexcept {
  Rest rest;
  ExitPath way;
  bool pressed = false;
  bool through_itself = false;
  double nearest = std::numeric_limits<double>::infinity();
  std::uint16_t hops = 0;
  for (int lift = 0; lift <= kLiftsMax; ++lift) {
    rest = descend(*mesh_, place_, p_OT);
    hops = static_cast<std::uint16_t>(hops + rest.hops);
    way = exit_path(*mesh_, rest);
    pressed = rest.settled && below(*mesh_, rest, p_OT);
    // A lift that ended no nearer: tip and surface coincide within rounding.
    if (pressed || !(rest.closest.distance_squared < nearest)) break;
    nearest = rest.closest.distance_squared;
    ++counters_.lifts;
    const Entry entry = search_->first_entry(rest.closest.p_OP + way.length * way.n_O, p_OT);
    if (entry.triangle < 0) {
      state_.hops = hops;
      // Where a surface passes through itself, the proxy was inside another part of it.
      if (!search_->inside(p_OT)) return;
      ++counters_.found_far;
      place_ = {.triangle =
                    search_->closest(p_OT, std::numeric_limits<double>::infinity()).triangle};
      rest = descend(*mesh_, place_, p_OT);
      way = exit_path(*mesh_, rest);
      pressed = through_itself = true;
      break;
    }
    ++counters_.stopped;
    // A slide that reached its bound continues from there in the next tick.
    if (!rest.settled) {
      ++counters_.long_walks;
      pressed = true;
      break;
    }
    place_ = {.triangle = entry.triangle};
  }

  const Vector3d p_OP = rest.closest.p_OP + way.length * way.n_O;
  // Held only where no direction is known to lead out and the exact result is "inside".
  if (way.sure || !search_->inside(p_OP)) {
    p_OP_ = p_OP;
  } else {
    ++counters_.held;
  }
  Vector3d n_O = way.n_O;
  if (pressed) {
    const Vector3d p_TP_O = rest.closest.p_OP - p_OT;
    if (rest.settled && rest.closest.place.on == SurfacePlace::On::kFace && !through_itself) {
      // Within rounding of the edge of a face, the way out also leads away from the adjacent faces.
      if (!way.from_face) n_O = rest.closest.normal.normalized();
      state_.depth = n_O.dot(p_TP_O);
    } else {
      state_.depth = std::sqrt(rest.closest.distance_squared);
      if (state_.depth > kDirectionMin * mesh_->depth_rounding()) n_O = p_TP_O / state_.depth;
    }
  }
  place_ = rest.closest.place;
  state_.touching = true;
  state_.triangle = rest.closest.place.triangle;
  state_.n_W = n_O;
  state_.p_WP = p_OP_;
  state_.hops = hops;
}

}  // namespace thimble::render
