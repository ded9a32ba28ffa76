#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "surface/map/map_follower.h"
#include "surface/map/surface_map.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/surface/spring_damper.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// Spring and damper of a surface whose stiffness follows a map. A ClosestPointStage.
///
/// With the depth D, as changed by a texture, and the stiffness k at the closest point, the energy
/// is k D^2 / 2 and the force
///
///   k D n - D^2 / 2 grad k,
///
/// its negative gradient: the second term pushes along the surface, towards softer places. The map
/// is felt by a MapFollower with the slope at which that term is at most half the normal force, and
/// its ramps as well. So the sum is at most the normal force, and no step of the map is a step of
/// the force. The damper does not depend on the map.
class MappedSpring {
 public:
  /// Takes the spring at white, and the share of its stiffness at black, 0 to 1. Precondition:
  /// there is a map. Real-time: never from the servo thread.
  MappedSpring(const SpringDamper& spring, std::shared_ptr<const SurfaceMap> map, double black,
               double white)
      : spring_(spring), map_(std::move(map)), black_(black), white_(white) {}

  /// See ClosestPointStage. Real-time: safe.
  void touch_at(const ClosestSurfacePoint& closest, const driver::DeviceState& state,
                SurfaceResponse& response) noexcept {
    const ContactState& contact = response.contact;
    // A conservative texture has tilted the normal and stretched the depth (texture_height.h).
    const double depth = contact.depth * std::max(contact.n_W.dot(closest.fall_W), 0.0);
    const double range = white_ - black_;
    MapFollower::Limits limits{.ramp = kSteepest, .steepest = kSteepest};
    if (depth > 0 && range != 0) {
      limits.steepest = std::min(share_ / (depth * std::abs(range)), kSteepest);
      limits.ramp = limits.steepest;
    }
    const MapFollower::Felt felt = follower_.follow(
        state.p_WT, closest, map_->at(contact.triangle, closest.p_M), map_->slope_max(), limits);
    const double share = black_ + range * felt.value;
    // Written so that NaN means no force.
    if (!(share >= 0)) return;
    share_ = std::max(share, kShareMin);
    const SpringDamper here{.stiffness = share * spring_.stiffness, .damping = spring_.damping};
    const Eigen::Vector3d f_W = here.force(contact, state);
    const double press = here.stiffness * depth;
    if (!(press > 0) || f_W.isZero()) return;
    Eigen::Vector3d aside_W = -depth * depth / 2 * range * spring_.stiffness * felt.slope_W;
    const double size = aside_W.norm();
    if (size > press) aside_W *= press / size;
    response.f_T_W += f_W;
    if (size < HUGE_VAL) response.f_T_W += aside_W;
  }
  /// The same on a flat surface. Real-time: safe.
  void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept {
    touch_at(flat_closest_point(response.contact), state, response);
  }
  void leave() noexcept {
    follower_.leave();
    share_ = std::max({black_, white_, kShareMin});
  }

  /// Returns the stiffness felt last, N/m; the largest outside of contact. Real-time: safe.
  double spring_stiffness() const noexcept { return share_ * spring_.stiffness; }

  /// Adds stiffness (at white) and damping. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings) { spring_.list_settings(settings); }

 private:
  // Bounds of the slope of the map where no force depends on it. [chosen: a step within a
  // micrometre]
  static constexpr double kSteepest = 1e6;  // 1/m
  static constexpr double kShareMin = 1e-3;

  SpringDamper spring_;
  std::shared_ptr<const SurfaceMap> map_;
  double black_, white_;
  MapFollower follower_;
  double share_ = std::max({black_, white_, kShareMin});  // felt last
};

}  // namespace thimble::render
