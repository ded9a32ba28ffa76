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
      message += " The arm is now disconnected.";
    }
    return {ArmHealth::kError, std::move(message)};
  }
  if (tick.stage == driver::DeviceStage::kWaiting) {
    return {ArmHealth::kWarn, "Forces are off: the enabling input is not held."};
  }
  if (tick.stage != driver::DeviceStage::kActive) {
    return {ArmHealth::kWarn, "Forces are off: the arm is not activated."};
  }
  const double heat = *std::max_element(tick.heat.begin(), tick.heat.end());
  if (heat >= driver::HeatGuard::kWarning) {
    return {ArmHealth::kWarn, "A motor is hot; the force is reduced until it cools."};
  }
  return {ArmHealth::kOk, "Forces are enabled."};
}

}  // namespace thimble::ros2
