#include "thimble/driver/discovery.h"

#include <fnmatch.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "board_identity.h"
#include "support/mock/fake_usb.h"

namespace thimble::driver {
namespace {

TEST(Discovery, WorksOrReportsAnErrorOnThisMachine) {
  const auto arms = find_arms();
  EXPECT_TRUE(arms || arms.error().message.find("Cannot list USB devices") != std::string::npos);
}

TEST(Discovery, ReadsOnlyTheInterfacesOfADevice) {
  const support::FakeUsb usb("discovery_links");
  usb.plug("1-1", "1234", "0006", "WH01", 1, 2);
  // As behind a link to the bus, whose folder contains all other devices.
  const auto elsewhere = usb.root() / usb.device_folder("1-1") / "subsystem";
  std::filesystem::create_directories(elsewhere / "devices/hidraw/hidraw9");
  std::filesystem::create_directories(elsewhere / "tty/ttyACM9");
  const auto arms = find_arms(usb.root());
  ASSERT_TRUE(arms) << arms.error().message;
  for (const FoundArm& arm : *arms) EXPECT_EQ(arm.node, "") << arm.arm;
}

TEST(Discovery, FindsEachArmWithItsNodeAndItsName) {
  const support::FakeUsb usb("discovery_each");
  usb.plug("1-1", "1234", "0006", "WH01", 1, 2);
  usb.bind("1-1", 0, "usbhid");
  usb.add_hidraw("1-1", 0, "hidraw3");
  usb.plug("1-2", "16c0", "0486", "", 1, 3);
  usb.call("1-2", "Polhem");
  usb.add_hidraw("1-2", 1, "hidraw5", 64, 0xffc9);  // the Teensy's debug output
  usb.add_hidraw("1-2", 0, "hidraw4", 64);
  usb.plug("1-3", "16c0", "0483", "7654321", 1, 4);
  usb.call("1-3", "WoodenHaptics");
  usb.add_tty("1-3", 0, "ttyACM0");
  usb.plug("1-4.2", "0403", "cb48", "FALCON", 1, 17);
  usb.plug("1-5", "2988", "0302", "T1", 1, 6);
  usb.plug("1-6", "0403", "6001", "CABLE", 1, 7);  // any other FTDI cable
  usb.plug("1-7", "16c0", "0482", "KEYBOARD", 1, 8);
  usb.plug("1-8", "16c0", "05df", "OTHER", 1, 9);  // another device with a shared id

  const auto arms = find_arms(usb.root());
  ASSERT_TRUE(arms) << arms.error().message;
  ASSERT_EQ(arms->size(), 5u);
  EXPECT_EQ((*arms)[0].kind, ArmKind::kWoody);
  EXPECT_EQ((*arms)[0].board, BoardKind::kMbedHid8);
  EXPECT_EQ((*arms)[0].certainty, Certainty::kProvesItself);
  EXPECT_EQ((*arms)[0].node, "/dev/hidraw3");
  EXPECT_EQ((*arms)[0].name(), "WH01");
  EXPECT_EQ((*arms)[0].vendor_id, 0x1234);
  EXPECT_EQ((*arms)[0].product_id, 0x0006);
  EXPECT_TRUE((*arms)[0].accessible);
  EXPECT_EQ((*arms)[1].kind, ArmKind::kPolhem);
  EXPECT_EQ((*arms)[1].certainty, Certainty::kKnown);
  EXPECT_EQ((*arms)[1].node, "/dev/hidraw4");
  EXPECT_EQ((*arms)[1].name(), "usb-1-2");
  EXPECT_EQ((*arms)[2].kind, ArmKind::kHfabLine);
  EXPECT_EQ((*arms)[2].certainty, Certainty::kKnown);
  EXPECT_EQ((*arms)[2].arm, "WoodenHaptics");
  EXPECT_EQ((*arms)[2].node, "/dev/ttyACM0");
  EXPECT_EQ((*arms)[3].kind, ArmKind::kFalcon);
  EXPECT_EQ((*arms)[3].node, "/dev/bus/usb/001/017");
  EXPECT_EQ((*arms)[3].usb.device, 17);
  EXPECT_EQ((*arms)[4].certainty, Certainty::kUnsupported);
}

/// A USB device, and its expected identification before it is opened.
struct Plugged {
  const char* vendor;
  const char* product_id;
  const char* product;
  int hid_bytes;  // 0: no HID; -1: HID without a descriptor
  bool tty;
  Certainty certainty;
  BoardKind board;
};

TEST(Discovery, IdentifiesAnArmOnlyByItsOwnProperties) {
  constexpr Plugged kBoards[] = {
      // The published boards: examples of mbed and Teensy, whose ids and strings other devices
      // share.
      {"1234", "0006", "HID DEVICE", 8, false, Certainty::kProvesItself, BoardKind::kMbedHid8},
      {"1234", "0006", "HID DEVICE", 14, false, Certainty::kUnknown, BoardKind::kMbedHid14},
      {"16c0", "0486", "Teensyduino RawHID", 64, false, Certainty::kUnknown,
       BoardKind::kTeensyRawHid64},
      {"16c0", "0483", "USB Serial", 0, true, Certainty::kUnknown, BoardKind::kTextLines},
      {"16c0", "048a", "Teensy MIDI", 0, true, Certainty::kUnknown, BoardKind::kTextLines},
      // The product string names the arm.
      {"1234", "0006", "Polhem", 14, false, Certainty::kKnown, BoardKind::kMbedHid14},
      {"16c0", "0483", "haptikfabriken", 0, true, Certainty::kKnown, BoardKind::kTextLines},
      // A part of a product string proves nothing.
      {"16c0", "0483", "Haptikfabriken arm", 0, true, Certainty::kUnknown, BoardKind::kTextLines},
      {"1234", "0006", "Not a Polhem", 14, false, Certainty::kUnknown, BoardKind::kMbedHid14},
      // Another manufacturer's arm, and properties that no arm has.
      {"16c0", "0483", "Haply inverse3", 0, true, Certainty::kUnsupported, BoardKind::kOther},
      {"16c0", "0483", "Haply robot", 0, true, Certainty::kUnsupported, BoardKind::kOther},
      {"16c0", "0483", "Inverse3", 0, true, Certainty::kUnsupported, BoardKind::kOther},
      {"16c0", "0486", "Polhem", 14, false, Certainty::kUnknown, BoardKind::kOther},
      {"1234", "0006", "HID DEVICE", 64, false, Certainty::kUnknown, BoardKind::kOther},
      {"1234", "0006", "WoodenHaptics", -1, false, Certainty::kUnknown, BoardKind::kOther},
      {"1234", "0006", "WoodenHaptics", 0, false, Certainty::kUnknown, BoardKind::kOther},
  };
  int number = 0;
  for (const Plugged& board : kBoards) {
    const support::FakeUsb usb("discovery_own_" + std::to_string(number++));
    usb.plug("1-1", board.vendor, board.product_id, "S1", 1, 2);
    usb.call("1-1", board.product);
    if (board.hid_bytes != 0) {
      usb.add_hidraw("1-1", 0, "hidraw3",
                     static_cast<unsigned char>(board.hid_bytes > 0 ? board.hid_bytes : 0));
    }
    if (board.tty) usb.add_tty("1-1", 0, "ttyACM0");
    const auto arms = find_arms(usb.root());
    ASSERT_TRUE(arms);
    ASSERT_EQ(arms->size(), 1u) << number;
    EXPECT_EQ(arms->front().certainty, board.certainty) << board.product << board.hid_bytes;
    EXPECT_EQ(arms->front().board, board.board) << board.product << board.hid_bytes;
  }
}

// The rule gives access to the boards that discovery identifies as arms by their product string,
// and to no other Teensy. In udev's globs, bars separate alternatives.
TEST(Discovery, TeensyArmsMatchTheUdevRule) {
  std::ifstream rules(std::filesystem::path(THIMBLE_SOURCE_DIR) / "udev/70-thimble.rules");
  int lines = 0;
  for (std::string line; std::getline(rules, line);) {
    if (line.find("==\"16c0\"") == std::string::npos) continue;
    ++lines;
    const std::size_t begin = line.find("{product}==\"");
    ASSERT_NE(begin, std::string::npos) << line;
    std::istringstream globs(line.substr(begin + 12, line.find('"', begin + 12) - begin - 12));
    std::vector<std::string> alternatives;
    for (std::string glob; std::getline(globs, glob, '|');) alternatives.push_back(glob);
    for (const char* product : {"WoodenHaptics", "Polhem v3", "my polhem", "Haptikfabriken",
                                "Teensyduino RawHID", "USB Serial", "Haply inverse3", "Phantom"}) {
      const bool allowed = std::any_of(
          alternatives.begin(), alternatives.end(),
          [&](const std::string& glob) { return fnmatch(glob.c_str(), product, 0) == 0; });
      const support::FakeUsb usb(std::string("discovery_rule_") + product);
      usb.plug("1-1", "16c0", "0483", "7654321", 1, 2);
      usb.call("1-1", product);
      usb.add_tty("1-1", 0, "ttyACM0");
      EXPECT_EQ(allowed, find_arms(usb.root())->front().certainty == Certainty::kKnown) << product;
    }
  }
  EXPECT_EQ(lines, 3);
}

TEST(Discovery, AmbiguousSerialNumbersUseTheSocketName) {
  const support::FakeUsb usb("discovery_names");
  usb.plug("1-1.4", "1234", "0006", "0123456789", 1, 2);  // as on every mbed board
  usb.plug("1-2", "1234", "0006", "0123456789", 1, 3);
  usb.plug("1-3", "16c0", "0483", "SIM0001", 1, 4);
  usb.plug("1-4", "0403", "cb48", "SIM0001", 1, 5);
  usb.plug("1-5", "0403", "cb48", "F1", 1, 6);
  const auto arms = find_arms(usb.root());
  ASSERT_TRUE(arms);
  std::vector<std::string> names;
  for (const FoundArm& arm : *arms) names.push_back(arm.name());
  EXPECT_EQ(names, (std::vector<std::string>{"usb-1-1.4", "usb-1-2", "usb-1-3", "usb-1-4", "F1"}));
}

TEST(Discovery, PlaceholderSerialNumbersAreNoName) {
  for (const char* serial : {"", "0123456789", "1234567890", "123456", "0000", "FFFFFFFF"}) {
    EXPECT_TRUE(is_placeholder(serial)) << serial;
  }
  for (const char* serial : {"SIM0001", "7654321", "WH01", "12345670", "01"}) {
    EXPECT_EQ(is_placeholder(serial), std::string_view(serial) == "01") << serial;
  }
}

TEST(Discovery, ReplacesControlCharactersInDeviceStrings) {
  const support::FakeUsb usb("discovery_escape");
  usb.plug("1-1", "0403", "cb48", "F\x1b[2J", 1, 2);
  EXPECT_EQ(find_arms(usb.root())->front().name(), "F?[2J");
}

TEST(Discovery, ReportsAnArmWithoutNodeOrAccess) {
  const support::FakeUsb usb("discovery_access");
  usb.plug("1-1", "1234", "0006", "WH01", 1, 2);
  auto arms = find_arms(usb.root());
  ASSERT_TRUE(arms);
  ASSERT_EQ(arms->size(), 1u);
  EXPECT_EQ(arms->front().node, "");
  EXPECT_FALSE(arms->front().accessible);
}

TEST(Discovery, StringsOfBoardsAndConvertersNameNoArm) {
  for (const char* common :
       {"", "USB Serial", "Dual Serial", "USB JTAG/serial debug unit", "Board in FS mode",
        "FT231X USB UART", "CP2104 USB to UART Bridge Controller", "PicoArduino", "Arduino Due",
        "STM32 Virtual ComPort", "Teensyduino RawHID", "TinyUSB Device", "USB2.0-Serial"}) {
    EXPECT_TRUE(is_common_product(common)) << common;
  }
  for (const char* own : {"Thimble arm: bench 3", "Pico haptic arm", "Pantograph of room 12"}) {
    EXPECT_FALSE(is_common_product(own)) << own;
  }
}

TEST(Discovery, MissingUsbIsAnError) {
  const auto arms = find_arms(support::scratch_folder() / "nothing_here");
  ASSERT_FALSE(arms);
  EXPECT_NE(arms.error().message.find("Cannot list USB devices"), std::string::npos);
}

}  // namespace
}  // namespace thimble::driver
