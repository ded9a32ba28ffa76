#pragma once

#include <Eigen/Core>
#include <optional>

#include "thimble/scene/arm_file.h"
#include "wires/wire_table.h"

namespace thimble::bringup {

/// The torques of an arm's messages. A wire transmits currents in steps, most wires in whole mA. A
/// force at its limit moves the motor of a capstan with the same current in many ticks, and so with
/// the same rounding error: unless it is taken into account, the gain of the motor is biased.
class SentTorques {
 public:
  /// Takes the motors and the wire of an arm. Real-time: never from the servo thread.
  explicit SentTorques(const scene::ArmFile& file);

  /// Returns the torques at the joints (N m) that the message for `tau` (N m) requests.
  Eigen::Vector3d sent(const Eigen::Vector3d& tau) const;

 private:
  Eigen::Vector3d per_ampere_;             // N m/A at the joints; 0: no such motor
  std::optional<driver::WireTable> wire_;  // of a described board
};

}  // namespace thimble::bringup
