#pragma once

#include <memory>
#include <utility>

#include "surface/map/map_follower.h"
#include "surface/map/surface_map.h"
#include "thimble/render/effect/stage_list.h"

namespace thimble::render {

/// A friction whose coefficients follow a map: a stage around one of the frictions.
///
/// Every friction law is proportional to coefficient times load. So a friction with the load times
/// a factor is that with all coefficients times it; viscous friction does not depend on it. Steps
/// of the map are spread over kStepPath of path. It takes energy with any factor.
class MappedFriction final : public AnyStage {
 public:
  /// Takes the friction and the factors at black and white, >= 0. Preconditions: there are a
  /// friction and a map. Real-time: never from the servo thread.
  MappedFriction(std::unique_ptr<AnyStage> friction, std::shared_ptr<const SurfaceMap> map,
                 double black, double white)
      : friction_(std::move(friction)), map_(std::move(map)), black_(black), white_(white) {}

  void touch_at(const ClosestSurfacePoint& closest, const driver::DeviceState& state,
                SurfaceResponse& response) noexcept override {
    const auto sample = [&](std::int32_t triangle, const Eigen::Vector3d& p_M) noexcept {
      return map_->at(triangle, p_M);
    };
    const MapFollower::Felt felt = follower_.follow(
        state.p_WT, closest, response.contact.triangle,
        sample(response.contact.triangle, closest.p_M), *map_, sample,
        {.ramp = 2 / kStepPath, .bend = 6 / (kStepPath * kStepPath), .steepest = 1 / kStepPath});
    const double factor = black_ + (white_ - black_) * felt.value;
    SurfaceResponse scaled = response;
    // Written so that NaN means no friction.
    scaled.f_T_W *= factor >= 0 ? factor : 0.0;
    const Eigen::Vector3d before = scaled.f_T_W;
    friction_->touch_at(closest, state, scaled);
    response.f_T_W += scaled.f_T_W - before;
  }
  void touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept override {
    touch_at(flat_closest_point(response.contact), state, response);
  }
  void leave() noexcept override {
    follower_.leave();
    friction_->leave();
  }
  bool needs_closest_point() const noexcept override { return true; }
  void list_settings(LiveSettings& settings) override { friction_->list_settings(settings); }

 private:
  // Path over which a step from black to white is felt, m. [chosen: a step within it is still
  // felt as a click] The limits of MapFollower follow from it: with the bend b the slope grows over
  // the path v / b to v and ends over 2 v / b, together the step v^2 / (2 b) + v^2 / b.
  static constexpr double kStepPath = 0.00025;

  std::unique_ptr<AnyStage> friction_;
  std::shared_ptr<const SurfaceMap> map_;
  double black_, white_;
  MapFollower follower_;
};

}  // namespace thimble::render
