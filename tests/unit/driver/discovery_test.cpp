#include "thimble/driver/discovery.h"

#include <gtest/gtest.h>

#include "support/fake_usb.h"

namespace thimble::driver {
namespace {

TEST(Discovery, KnowsTheArmsByTheirUsbIds) {
  EXPECT_STREQ(arm_of_usb_id(0x1234, 0x0006), "WoodenHaptics");
  EXPECT_STREQ(arm_of_usb_id(0x0403, 0xcb48), "Novint Falcon");
  EXPECT_STREQ(arm_of_usb_id(0x16c0, 0x0486), "Polhem v2");
  EXPECT_STREQ(arm_of_usb_id(0x16c0, 0x0483), "hfab (Teensy)");
  EXPECT_EQ(arm_of_usb_id(0x0403, 0x6001), nullptr);  // any other FTDI cable
  EXPECT_EQ(arm_of_usb_id(0x16c0, 0x05df), nullptr);  // somebody else's device with a shared id
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

TEST(Discovery, FindsEachArmWithItsNodeAndItsName) {
  const support::FakeUsb usb("discovery_each");
  usb.plug("1-1", "1234", "0006", "WH01", 1, 2);
  usb.bind("1-1", 0, "usbhid");
  usb.add_hidraw("1-1", 0, "hidraw3");
  usb.plug("1-2", "16c0", "0486", "", 1, 3);
  usb.add_hidraw("1-2", 1, "hidraw5");  // the Teensy's debug output
  usb.add_hidraw("1-2", 0, "hidraw4");
  usb.plug("1-3", "16c0", "0483", "7654321", 1, 4);
  usb.add_tty("1-3", 0, "ttyACM0");
  usb.plug("1-4.2", "0403", "cb48", "FALCON", 1, 17);
  usb.plug("1-5", "2988", "0302", "T1", 1, 6);
  usb.plug("1-6", "0403", "6001", "CABLE", 1, 7);
  usb.plug("1-7", "16c0", "0482", "KEYBOARD", 1, 8);

  const auto arms = find_arms(usb.root());
  ASSERT_TRUE(arms) << arms.error().message;
  ASSERT_EQ(arms->size(), 5u);
  EXPECT_EQ((*arms)[0].kind, ArmKind::kWoody);
  EXPECT_EQ((*arms)[0].node, "/dev/hidraw3");
  EXPECT_EQ((*arms)[0].name(), "WH01");
  EXPECT_TRUE((*arms)[0].accessible);
  EXPECT_EQ((*arms)[1].kind, ArmKind::kPolhem);
  EXPECT_EQ((*arms)[1].node, "/dev/hidraw4");
  EXPECT_EQ((*arms)[1].name(), "usb-1-3");
  EXPECT_EQ((*arms)[2].kind, ArmKind::kHfabLine);
  EXPECT_EQ((*arms)[2].node, "/dev/ttyACM0");
  EXPECT_EQ((*arms)[3].kind, ArmKind::kFalcon);
  EXPECT_EQ((*arms)[3].node, "/dev/bus/usb/001/017");
  EXPECT_EQ((*arms)[3].usb.device, 17);
  EXPECT_EQ((*arms)[4].kind, ArmKind::kUnsupported);
}

TEST(Discovery, TellsAnArmWithoutANodeOrWithoutAccess) {
  const support::FakeUsb usb("discovery_access");
  usb.plug("1-1", "1234", "0006", "WH01", 1, 2);
  auto arms = find_arms(usb.root());
  ASSERT_TRUE(arms);
  ASSERT_EQ(arms->size(), 1u);
  EXPECT_EQ(arms->front().node, "");
  EXPECT_FALSE(arms->front().accessible);
}

TEST(Discovery, SaysSoWhenThereIsNoUsbAtAll) {
  const auto arms = find_arms(support::scratch_folder() / "nothing_here");
  ASSERT_FALSE(arms);
  EXPECT_NE(arms.error().message.find("cannot be listed"), std::string::npos);
}

}  // namespace
}  // namespace thimble::driver
