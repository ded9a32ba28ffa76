#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "thimble/device_sim/usb/usb_device.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim::usb {

/// What is true of a simulated arm at its last packets; a driver cannot see it. Frame B: base of
/// the arm.
struct ArmTruth {
  std::uint64_t reports = 0;                   ///< Reports that the host took.
  std::int64_t report_ns = 0;                  ///< When the last of them was sampled, ns.
  std::array<std::int32_t, 3> counts{};        ///< What it said, counts.
  Eigen::Vector3d exact_counts{0, 0, 0};       ///< The same before rounding to whole counts.
  std::uint64_t messages = 0;                  ///< Messages that came and were understood.
  std::int64_t message_ns = 0;                 ///< When the last of them came, ns.
  std::array<std::int32_t, 3> motor_values{};  ///< What it asked for, in the wire's unit.
  Eigen::Vector3d currents{0, 0, 0};           ///< What flows in the motors now, A or motor units.
  Eigen::Vector3d p_BT{0, 0, 0};               ///< Where the tip is now, m.
  bool motors_on = false;                      ///< False before the first message and after the
                                               ///< watchdog fired.
};

/// A simulated arm on a USB plug.
class THIMBLE_EXPORT UsbArm : public UsbDevice {
 public:
  /// Shows what is true. Real-time: safe.
  virtual ArmTruth truth() const noexcept = 0;
  /// Leads the hand to a place (m, base) from now on, in place of its path. Real-time: safe.
  virtual void lead_hand(const Eigen::Vector3d& p_BH) noexcept = 0;
  /// Lets the hand take the tip, which it does from the beginning, or let go of it. Real-time:
  /// safe.
  virtual void hold_tip(bool held) noexcept = 0;
  /// Restarts the board on a live wire: the plug stays enumerated, the motors go off, and the
  /// encoders count from zero where the arm is now. A Falcon loses its firmware and answers nothing
  /// until it is booted again. Real-time: safe.
  virtual void restart_board() noexcept = 0;
  /// Fixes a mass (kg, 0: none) to the tip, in place of one that was fixed to it before; gravity_B
  /// (m/s^2) pulls on it. Fails if it is negative or not finite. Real-time: never from the servo
  /// thread.
  virtual driver::Result<void> fix_mass(double mass, const Eigen::Vector3d& gravity_B) = 0;
};

}  // namespace thimble::device_sim::usb
