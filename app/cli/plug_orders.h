#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "thimble/device_sim/usb/usb_arm.h"
#include "thimble/device_sim/usb/usb_fault.h"

namespace thimble::cli {

/// A plugged arm as a script orders it about: faults of the plug, what the hand on it does, and
/// what is fixed to its tip.
struct Plugged {
  device_sim::usb::FaultyDevice& device;
  device_sim::usb::UsbArm& arm;
  Eigen::Vector3d p_BH{0, 0, 0};             ///< Where the hand began, m.
  std::optional<Eigen::Vector3d> gravity_B;  ///< m/s^2; none: nothing says where down is.
};

/// Carries out one line of a script: a fault (parse_fault), `heal`, `hand X Y Z`, `hand off`,
/// `hand on` or `mass KG`. A mistake is told and changes nothing; returns whether there was none.
/// Real-time: never from the servo thread.
bool obey(Plugged& plugged, const std::string& line);

/// Carries out a whole file of them, up to the first mistake. Real-time: never from the servo
/// thread.
bool obey_file(Plugged& plugged, const std::string& path);

/// A named pipe that takes such lines while the arm is plugged in. Real-time: never from the servo
/// thread.
class OrderPipe {
 public:
  OrderPipe() = default;
  OrderPipe(const OrderPipe&) = delete;
  OrderPipe& operator=(const OrderPipe&) = delete;
  ~OrderPipe();

  /// Makes the pipe; fails if something of that name is there. It is removed with this.
  bool open(const std::string& path);
  /// Carries out what has come since the last call, if it is open.
  void poll(Plugged& plugged);

 private:
  std::string path_, line_;
  int file_ = -1;
};

}  // namespace thimble::cli
