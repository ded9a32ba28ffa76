#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/device_sim/usb/usb_device.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim::usb {

/// Ground truth of a simulated arm at its last packets; not visible to a driver. Frame B: base of
/// the arm.
struct ArmTruth {
  std::uint64_t reports = 0;              ///< Number of reports that the host read.
  std::int64_t report_ns = 0;             ///< Time at which the last report was sampled, ns.
  std::array<std::int32_t, 3> counts{};   ///< Counts in the last report.
  Eigen::Vector3d exact_counts{0, 0, 0};  ///< Counts before rounding to integers.
  std::uint64_t messages = 0;             ///< Number of valid messages received.
  std::int64_t message_ns = 0;            ///< Time at which the last message arrived, ns.
  /// Motor values in the last message, in the unit of the protocol.
  std::array<std::int32_t, 3> motor_values{};
  Eigen::Vector3d currents{0, 0, 0};  ///< Current in the motors now, A or motor units.
  Eigen::Vector3d p_BT{0, 0, 0};      ///< Position of the tip now, m.
  /// True if the motors are on; false before the first message and after the watchdog has fired.
  bool motors_on = false;
};

/// Simulated arm with a USB connection.
class THIMBLE_EXPORT UsbArm : public UsbDevice {
 public:
  /// Returns the ground truth. Real-time: safe.
  virtual ArmTruth truth() const noexcept = 0;
  /// Moves the target of the hand to a position (m, base); replaces its path. Real-time: safe.
  virtual void lead_hand(const Eigen::Vector3d& p_BH) noexcept = 0;
  /// Makes the hand hold the tip (the initial state) or release it. Real-time: safe.
  virtual void hold_tip(bool held) noexcept = 0;
  /// Restarts the board without a disconnection: the USB device stays enumerated, the motors are
  /// switched off, and the encoders count from zero at the current pose. A Falcon loses its
  /// firmware and does not answer until it is booted again. Real-time: safe.
  virtual void restart_board() noexcept = 0;
  /// Attaches a mass (kg, 0: none) to the tip; replaces a mass attached before. gravity_B (m/s^2)
  /// acts on it. Fails if the mass is negative or not finite. Real-time: never from the servo
  /// thread.
  virtual driver::Result<void> fix_mass(double mass, const Eigen::Vector3d& gravity_B) = 0;
};

}  // namespace thimble::device_sim::usb
