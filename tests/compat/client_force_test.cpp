// The program's force as a force law, tick by tick in virtual time.
#include "compat/server/client_force.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "thimble/driver/servo_loop.h"
#include "thimble/scene/simulated_device.h"

namespace thimble::compat {
namespace {

/// Runs an arm for a second, with a fault at 0.2 s. The program enables the force again at 0.5 s.
/// Returns whether the arm is in fault at 0.9 s.
bool fault_stays(bool may_activate) {
  auto opened = scene::SimulatedDevice::open("vintage_phantom", {{0, {0, 0, 0}}, {2, {0, 0, 0}}});
  EXPECT_TRUE(opened) << opened.error().message;
  scene::SimulatedDevice& arm = **opened;
  EXPECT_TRUE(arm.device().activate());
  const auto channel = std::make_unique<ArmChannel>();
  channel->enabled = 1;
  auto nothing = [](const driver::DeviceState&) noexcept { return driver::ForceCommand{}; };
  ClientForce client(*channel, driver::ForceLaw(nothing), arm.device(), may_activate);
  int tick = 0;
  bool in_fault = false;
  auto law = [&](const driver::DeviceState& state) noexcept {
    if (++tick == 200) arm.device().trip(driver::Fault::kOverSpeed);
    if (tick == 500) channel->enablings.fetch_add(1);
    if (tick == 900) in_fault = arm.device().fault() != driver::Fault::kNone;
    return client(state);
  };
  auto sink = [](const driver::TickRecord&) noexcept {};
  const std::atomic<bool> never{false};
  driver::run_servo(arm.device(), arm.clock(), driver::ForceLaw(law), driver::TickSink(sink),
                    {.period_ns = arm.period_ns(), .ticks = 1000, .continue_after_faults = true},
                    never);
  EXPECT_GE(tick, 900);
  return in_fault;
}

TEST(ClientForce, EnablingForceClearsAFaultOfASimulatedArm) {
  EXPECT_FALSE(fault_stays(true));
}

TEST(ClientForce, FaultOfARealArmNeedsAPerson) {
  EXPECT_TRUE(fault_stays(false));
}

}  // namespace
}  // namespace thimble::compat
