#include "ros2/arm_health.h"

#include <algorithm>
#include <utility>

#include "thimble/driver/heat_guard.h"

namespace thimble::ros2 {

ArmHealth health_of(const driver::TickRecord& tick) {
  if (tick.fault != driver::Fault::kNone) {
    std::string message(driver::describe(tick.fault));
    // The fault is the first cause; the arm may be unplugged later.
    if (tick.link == driver::LinkState::kLost && tick.fault != driver::Fault::kTransportLost) {
      message += " The arm is gone from the wire now.";
    }
    return {ArmHealth::kError, std::move(message)};
  }
  if (tick.stage == driver::DeviceStage::kWaiting) {
    return {ArmHealth::kWarn, "No forces: the enabling input is not held."};
  }
  if (tick.stage != driver::DeviceStage::kActive) {
    return {ArmHealth::kWarn, "No forces: the arm is not activated."};
  }
  const double heat = *std::max_element(tick.heat.begin(), tick.heat.end());
  if (heat >= driver::HeatGuard::kWarning) {
    return {ArmHealth::kWarn, "A motor is hot; the force is lowered until it cools."};
  }
  return {ArmHealth::kOk, "Forces go through the safety gate."};
}

}  // namespace thimble::ros2
