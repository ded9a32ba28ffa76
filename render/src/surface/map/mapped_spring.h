#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "math/elementary.h"
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
/// its negative gradient: the second term pushes along the surface, towards softer places. It is k
/// D n times D / 2 times the gradient of log k. So a MapFollower follows log k, with a gradient of
/// at most 1 / D and ramps of as much: each pushes aside with at most half the normal force, and
/// both with at most all of it. A ramp bends so that the force aside changes by at most k times the
/// path, as the force of the spring does. A sharp border is so spread over a path of some depths,
/// and no step of the map is a step of the force. The damper does not depend on the map.
class MappedSpring {
 public:
  /// Takes the spring, and the shares of its stiffness at black and white, 0 to 1. Precondition:
  /// there is a map. Real-time: never from the servo thread.
  MappedSpring(const SpringDamper& spring, std::shared_ptr<const SurfaceMap> map, double black,
               double white)
      : spring_(spring),
        map_(std::move(map)),
        black_(std::max(black, kShareMin)),
        white_(std::max(white, kShareMin)),
        low_(std::min(black_, white_)),
        high_(std::max(black_, white_)),
        logs_(high_ > low_ ? math::log(high_ / low_) : 1),
        share_(high_) {}

  /// See ClosestPointStage. Real-time: safe.
  void touch_at(const ClosestSurfacePoint& closest, const driver::DeviceState& state,
                SurfaceResponse& response) noexcept {
    const ContactState& contact = response.contact;
    // A conservative texture has tilted the normal and stretched the depth (texture_height.h).
    const double depth = contact.depth * std::max(contact.n_W.dot(closest.fall_W), 0.0);
    const auto share_at = [&](const SurfaceMap::Sample& found) noexcept {
      return black_ + (white_ - black_) * found.value;
    };
    // The logarithm, from 0 at the softest place to 1 at the stiffest.
    const auto log_of = [&](const SurfaceMap::Sample& found) noexcept {
      const double share = share_at(found);
      return SurfaceMap::Sample{.value = std::clamp(math::log(share / low_) / logs_, 0.0, 1.0),
                                .slope_M = (white_ - black_) / (share * logs_) * found.slope_M};
    };
    const SurfaceMap::Sample found = map_->at(contact.triangle, closest.p_M);
    const double steepest = limited(1 / (depth * logs_), kSteepest);
    const MapFollower::Felt felt =
        follower_.follow(state.p_WT, closest, contact.triangle, log_of(found), *map_,
                         [&](std::int32_t triangle, const Eigen::Vector3d& p_M) noexcept {
                           return log_of(map_->at(triangle, p_M));
                         },
                         {.ramp = steepest,
                          .bend = limited(2 / (depth * depth * logs_), kSteepest * kSteepest),
                          .steepest = steepest});
    const double share = share_at(found);
    const double felt_share = follower_.lags() ? low_ * math::exp(logs_ * felt.value) : share;
    // Written so that NaN means no force.
    if (!(felt_share > 0)) return;
    share_ = felt_share;
    const SpringDamper here{.stiffness = felt_share * spring_.stiffness,
                            .damping = spring_.damping};
    const Eigen::Vector3d f_W = here.force(contact, state);
    const double press = here.stiffness * depth;
    if (!(press > 0) || f_W.isZero(0)) return;
    Eigen::Vector3d aside_W = -press * depth / 2 * logs_ * felt.slope_W;
    // Only after a quick change of the depth, until the ramp has become longer.
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
    share_ = high_;
  }

  /// Returns the stiffness felt last, N/m; the largest outside of contact. Real-time: safe.
  double spring_stiffness() const noexcept { return share_ * spring_.stiffness; }

  /// Adds the largest stiffness and the damping. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings) { spring_.list_settings(settings); }

 private:
  // Returns a limit of the slope, or the largest one if it is larger, or NaN.
  static double limited(double limit, double largest) noexcept {
    return limit < largest ? limit : largest;
  }

  static constexpr double kShareMin = 1e-5;  // 1 N/m of the largest stiffness of a scene
  // Gradient that is felt where it causes no force, 1/m. [chosen: a step within a micrometre]
  static constexpr double kSteepest = 1e6;

  SpringDamper spring_;
  std::shared_ptr<const SurfaceMap> map_;
  double black_, white_, low_, high_;
  double logs_;  // logarithm of their ratio; 1 if they are equal
  MapFollower follower_;
  double share_;  // felt last
};

}  // namespace thimble::render
