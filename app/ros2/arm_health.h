#pragma once

#include <cstdint>
#include <string>

#include "thimble/driver/tick_record.h"

namespace thimble::ros2 {

/// Health of an arm for ROS 2 (diagnostic_msgs/DiagnosticStatus).
struct ArmHealth {
  /// OK, WARN and ERROR of DiagnosticStatus [S ros2/common_interfaces, DiagnosticStatus.msg].
  enum Level : std::uint8_t { kOk = 0, kWarn = 1, kError = 2 };

  Level level = kOk;
  std::string message;  ///< One sentence or two.

  friend bool operator==(const ArmHealth&, const ArmHealth&) = default;
};

/// Returns the health of the arm in a tick: in fault; without forces; with a motor near its heat
/// limit; or OK. Real-time: never from the servo thread.
ArmHealth health_of(const driver::TickRecord& tick);

}  // namespace thimble::ros2
