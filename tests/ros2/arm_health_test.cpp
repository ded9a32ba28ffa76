#include "ros2/arm_health.h"

#include <gtest/gtest.h>

namespace thimble::ros2 {
namespace {

TEST(ArmHealth, NamesAFaultBeforeAllElse) {
  driver::TickRecord tick;
  tick.stage = driver::DeviceStage::kActive;
  EXPECT_EQ(health_of(tick).level, ArmHealth::kOk);
  tick.heat = {0.1, 0.85, 0.2};
  EXPECT_EQ(health_of(tick).level, ArmHealth::kWarn);
  EXPECT_NE(health_of(tick).message.find("hot"), std::string::npos);
  tick.stage = driver::DeviceStage::kIdle;
  EXPECT_EQ(health_of(tick).level, ArmHealth::kWarn);
  EXPECT_NE(health_of(tick).message.find("not activated"), std::string::npos);
  tick.stage = driver::DeviceStage::kWaiting;
  EXPECT_NE(health_of(tick).message.find("not held"), std::string::npos);
  tick.stage = driver::DeviceStage::kFault;
  tick.fault = driver::Fault::kOverSpeed;
  EXPECT_EQ(health_of(tick).level, ArmHealth::kError);
  EXPECT_EQ(health_of(tick).message, driver::describe(driver::Fault::kOverSpeed));
}

TEST(ArmHealth, NamesALossAfterAnotherFault) {
  driver::TickRecord tick;
  tick.stage = driver::DeviceStage::kFault;
  tick.fault = driver::Fault::kOverSpeed;
  tick.link = driver::LinkState::kLost;
  EXPECT_NE(health_of(tick).message.find("disconnected"), std::string::npos);
}

}  // namespace
}  // namespace thimble::ros2
