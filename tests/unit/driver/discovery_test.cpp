#include "thimble/driver/discovery.h"

#include <gtest/gtest.h>

namespace thimble::driver {
namespace {

TEST(Discovery, KnowsTheArmsByTheirUsbIds) {
  EXPECT_STREQ(arm_of_usb_id(0x1234, 0x0006), "WoodenHaptics");
  EXPECT_STREQ(arm_of_usb_id(0x0403, 0xcb48), "Novint Falcon");
  EXPECT_EQ(arm_of_usb_id(0x0403, 0x6001), nullptr);  // any other FTDI cable
}

TEST(Discovery, ListsKnownArmsOnlyOrSaysWhyItCannot) {
  const auto arms = find_arms();
  if (!arms) {
    EXPECT_NE(arms.error().message.find("cannot be listed"), std::string::npos);
    return;
  }
  for (const FoundArm& arm : *arms) {
    EXPECT_STREQ(arm_of_usb_id(arm.vendor_id, arm.product_id), arm.arm.c_str());
  }
}

}  // namespace
}  // namespace thimble::driver
