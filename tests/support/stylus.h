#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "thimble/driver/device_state.h"
#include "thimble/render/object_touch.h"

namespace thimble::support {

/// A free point mass in simulated time that touches one object, with or without the spring and
/// damper of a hand. Positions are ideal; forces are held for a tick.
struct Stylus {
  double mass = 0.1;  ///< kg
  double step = 1e-3;
  double hand_stiffness = 0;  ///< N/m, to p_WH
  double hand_damping = 0;    ///< N s/m
  Eigen::Vector3d p_WT{0, 0, 0}, v_WT{0, 0, 0}, p_WH{0, 0, 0};
  std::uint64_t tick = 0;

  driver::DeviceState state() const {
    driver::DeviceState now;
    now.tick = tick;
    now.time_ns = static_cast<std::int64_t>(1e9 * step * static_cast<double>(tick));
    now.dt = tick > 0 ? step : 0;
    now.p_WT = p_WT;
    now.v_WT = v_WT;
    return now;
  }

  /// Advances by one tick against `object`; returns its force.
  driver::ForceCommand follow(render::ObjectTouch& object) {
    const driver::ForceCommand command = object.update(state());
    ++tick;
    v_WT += step / mass * (command.f_T_W + hand_stiffness * (p_WH - p_WT) - hand_damping * v_WT);
    p_WT += step * v_WT;
    return command;
  }
  double energy() const {
    return mass * v_WT.squaredNorm() / 2 + hand_stiffness * (p_WH - p_WT).squaredNorm() / 2;
  }
  Eigen::Vector3d momentum() const { return mass * v_WT; }
  Eigen::Vector3d angular_momentum() const { return p_WT.cross(momentum()); }
};

}  // namespace thimble::support
