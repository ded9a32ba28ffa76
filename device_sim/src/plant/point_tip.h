#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "plant/axis_dynamics.h"
#include "plant/tip_kinematics.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// A tip without links: a mass with friction. Each axis moves by its exact map. Frame B: base. All
/// functions but `make` are Real-time: safe.
class THIMBLE_EXPORT PointTip {
 public:
  using State = std::array<AxisState, 3>;

  /// Makes the tip at rest at p_BT (m). Fails if a constant is out of range, or if the joints have
  /// friction, which it does not model. Real-time: never from the servo thread.
  template <class Geometry>
  static driver::Result<PointTip> make(const Geometry&, const SimulatedArmSettings& settings,
                                       const Eigen::Vector3d& p_BT) {
    const auto dynamics = AxisDynamics::make(settings.plant, settings.hand);
    if (!dynamics) return dynamics.error();
    if (settings.drive_train.has_joint_friction()) {
      return driver::Error{"Friction of the joints requires a tip model with joints (LinkedTip)."};
    }
    return PointTip(*dynamics, p_BT);
  }

  /// Advances by dt_ns under a held force (N), while the hand's point moves from p_BH (m) at
  /// constant velocity.
  void step(const std::optional<TipPose>&, const Eigen::Vector3d& force,
            const Eigen::Vector3d& p_BH, const Eigen::Vector3d& v_BH, std::int64_t dt_ns) noexcept {
    for (int i = 0; i < 3; ++i) {
      dynamics_.step(axes_[static_cast<std::size_t>(i)],
                     {.force = force[i], .anchor = p_BH[i], .anchor_speed = v_BH[i]}, dt_ns);
    }
  }

  /// Sets other constants of mass, friction and hand; the motion continues unchanged.
  void take(const AxisDynamics& dynamics) noexcept { dynamics_ = dynamics; }

  Eigen::Vector3d p_BT() const noexcept { return {axes_[0].x, axes_[1].x, axes_[2].x}; }
  Eigen::Vector3d v_BT() const noexcept { return {axes_[0].v, axes_[1].v, axes_[2].v}; }
  const State& state() const noexcept { return axes_; }
  /// Sets position (m) and velocity (m/s).
  void put(const Eigen::Vector3d& p_BT, const Eigen::Vector3d& v_BT) noexcept {
    for (int i = 0; i < 3; ++i) axes_[static_cast<std::size_t>(i)] = {p_BT[i], v_BT[i]};
  }
  /// Returns to an earlier position, at rest.
  void stop_at(const State& before) noexcept {
    axes_ = before;
    for (AxisState& axis : axes_) axis.v = 0;
  }

 private:
  PointTip(const AxisDynamics& dynamics, const Eigen::Vector3d& p_BT) noexcept
      : dynamics_(dynamics),
        axes_{AxisState{p_BT.x(), 0}, AxisState{p_BT.y(), 0}, AxisState{p_BT.z(), 0}} {}

  AxisDynamics dynamics_;
  State axes_;
};

}  // namespace thimble::device_sim
