#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "thimble/driver/device_state.h"
#include "thimble/render/multirate/local_model.h"

namespace thimble::support {

/// A surface in closed form that replaces a slow simulation: a plane, ball or bowl. Its force is k
/// d, or grows faster or slower than the depth d.
struct SlowSurface {
  enum class Shape { kPlane, kBall, kBowl };
  enum class Feel { kEven, kStiffening, kSoftening };
  Shape shape = Shape::kPlane;
  Feel feel = Feel::kEven;
  double stiffness = 800;  ///< Largest stiffness up to a depth of 3 mm, N/m.
  double radius = 0.03;    ///< Of ball and bowl, m.
  double damping = 0;      ///< N s/m
  /// Its highest point, or the bowl's lowest; the free side is +z there.
  Eigen::Vector3d p_WS{0, 0, 0};

  /// Computes depth (below 0 outside) and normal.
  double depth(const Eigen::Vector3d& p_WT, Eigen::Vector3d& n_W) const {
    n_W = Eigen::Vector3d::UnitZ();
    if (shape == Shape::kPlane) return p_WS.z() - p_WT.z();
    const double side = shape == Shape::kBall ? 1 : -1;
    const Eigen::Vector3d from = p_WT - (p_WS - side * radius * n_W);
    n_W = side * from.normalized();
    return side * (radius - from.norm());
  }

  double force(double d) const {
    if (!(d > 0)) return 0;
    switch (feel) {
      case Feel::kEven:
        return stiffness * d;
      case Feel::kStiffening:
        return stiffness * (0.2 * d + 0.4 * d * d / 0.003);
      case Feel::kSoftening:
        return stiffness * 0.002 * -std::expm1(-d / 0.002);
    }
    return 0;
  }
  double slope(double d) const {
    d = std::max(d, 0.0);
    switch (feel) {
      case Feel::kEven:
        return stiffness;
      case Feel::kStiffening:
        return stiffness * (0.2 + 0.8 * d / 0.003);
      case Feel::kSoftening:
        return stiffness * std::exp(-d / 0.002);
    }
    return 0;
  }

  /// Computes the local model near the tip, as a slow simulation would publish it.
  render::LocalModel model_at(const driver::DeviceState& state) const {
    render::LocalModel model;
    const double d = depth(state.p_WT, model.n_W);
    model.time_ns = state.time_ns;
    model.damping = damping;
    const double f = force(d);
    // While the tip is free: the closest point of the surface.
    model.p_WR = d > 0 ? state.p_WT : Eigen::Vector3d(state.p_WT + d * model.n_W);
    model.f_T_W = f * model.n_W;
    model.stiffness = slope(d) * model.n_W * model.n_W.transpose();
    if (shape ==
        Shape::kBowl) {  // The normal turns against the motion; over a ball it turns with it.
      model.stiffness += f / (radius - std::max(d, 0.0)) *
                         (Eigen::Matrix3d::Identity() - model.n_W * model.n_W.transpose());
    }
    model.stiffness = render::without_negative(model.stiffness);
    return model;
  }
};

/// A thread of 60 Hz in simulated time: reads the tip, computes for a whole period, publishes,
/// repeats. It can stop for a while.
class SlowSide {
 public:
  explicit SlowSide(const SlowSurface& felt, double phase = 0) : surface(felt) {
    next_ns_ = static_cast<std::int64_t>(phase * kPeriod_ns);
  }

  static constexpr double kPeriod_ns = 1e9 / 60;

  void tick(const driver::DeviceState& state) noexcept {
    if (state.time_ns < next_ns_) return;
    next_ns_ += static_cast<std::int64_t>(kPeriod_ns);
    const bool silent = state.time_ns >= silent_from_ns && state.time_ns < silent_to_ns;
    if (computed_ && !silent) {
      published = *computed_;
      refused += !slot.publish(*computed_);
      fresh = true;
    }
    if (!silent) computed_ = surface.model_at(state);
  }

  SlowSurface surface;
  render::ModelSlot slot;
  std::int64_t silent_from_ns = 0, silent_to_ns = 0;
  std::optional<render::LocalModel> published;
  int refused = 0;
  bool fresh = false;  ///< Set when a model is published, for counting.

 private:
  std::int64_t next_ns_;
  std::optional<render::LocalModel> computed_;
};

}  // namespace thimble::support
