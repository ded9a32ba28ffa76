#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "thimble/device_sim/usb/usb_arm.h"
#include "thimble/device_sim/usb/usb_fault.h"

namespace thimble::cli {

/// A plugged simulated arm that a script controls: faults of the plug, motion of the hand on it,
/// and the mass on its tip.
struct PluggedArm {
  device_sim::usb::FaultyDevice& device;
  device_sim::usb::UsbArm& arm;
  Eigen::Vector3d p_BH{0, 0, 0};             ///< Start of the hand, m.
  std::optional<Eigen::Vector3d> gravity_B;  ///< m/s^2; none: the direction of gravity is unknown.
};

/// Executes one line of a script: a fault (parse_fault), `heal`, `hand X Y Z`, `hand off`, `hand
/// on` or `mass KG`. An invalid line is reported and changes nothing. Returns whether the line is
/// valid. Real-time: never from the servo thread.
bool execute_line(PluggedArm& plugged, const std::string& line);

/// Executes a file of such lines, up to the first invalid one. Real-time: never from the servo
/// thread.
bool execute_file(PluggedArm& plugged, const std::string& path);

/// A named pipe that accepts such lines while the arm is plugged in. Real-time: never from the
/// servo thread.
class CommandPipe {
 public:
  CommandPipe() = default;
  CommandPipe(const CommandPipe&) = delete;
  CommandPipe& operator=(const CommandPipe&) = delete;
  ~CommandPipe();

  /// Makes the pipe; fails if a file of that name exists. The destructor removes the pipe.
  bool open(const std::string& path);
  /// Executes the lines received since the last call, if the pipe is open.
  void poll(PluggedArm& plugged);

 private:
  std::string path_, line_;
  int file_ = -1;
};

}  // namespace thimble::cli
