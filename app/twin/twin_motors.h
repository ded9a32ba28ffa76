#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "thimble/device_sim/settings.h"
#include "thimble/scene/arm_file.h"

namespace thimble::twin {

/// Delay from recorded ticks to the motors: within a tick the previous currents last for the
/// delay's fraction.
struct TwinDelay {
  std::size_t whole = 0;  // ticks
  std::int64_t part_ns = 0, rest_ns = 0;

  TwinDelay(const scene::ArmFile& file, double dt) {
    const auto& wire = file.simulated.wire;
    const auto tick_ns = static_cast<std::int64_t>(std::llround(1e9 * dt));
    const std::int64_t delay_ns = wire.delay_in_ns + wire.delay_out_ns;
    whole = static_cast<std::size_t>(delay_ns / tick_ns);
    part_ns = delay_ns % tick_ns;
    rest_ns = tick_ns - part_ns;
  }
};

/// Converts recorded currents to torques.
struct TwinMotors {
  Eigen::Vector3d torque_per_ampere;  // N m/A at the joints
  double current_max;                 // A
  device_sim::WiringSettings wiring;

  explicit TwinMotors(const scene::ArmFile& file)
      : current_max(file.simulated.motors.current_max), wiring(file.simulated.firmware.wiring) {
    for (int i = 0; i < 3; ++i) {
      const driver::MotorDrive& drive = file.model.drives[static_cast<std::size_t>(i)];
      torque_per_ampere[i] = drive.sign * drive.ratio * drive.torque_constant;
    }
  }

  Eigen::Vector3d torque(const Eigen::Vector3d& amperes) const {
    const Eigen::Vector3d flowing =
        wiring.motors(amperes).cwiseMax(-current_max).cwiseMin(current_max);
    return torque_per_ampere.cwiseProduct(flowing);
  }
};

}  // namespace thimble::twin
