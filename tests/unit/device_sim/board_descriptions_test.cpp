// USB descriptors of the boards, byte for byte as in the sources of their libraries. The bytes were
// typed from those sources, independently of the code under test.
#include "usb/board_descriptions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include "support/boards/usb_host.h"
#include "thimble/device_sim/usb/arm_shelf.h"
#include "usb/usb_description.h"

namespace thimble::device_sim::usb {
namespace {

std::vector<std::byte> bytes_of(std::initializer_list<unsigned> values) {
  std::vector<std::byte> bytes;
  for (const unsigned value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

std::string text_of(const UsbDescription& d, std::uint8_t index) {
  const auto bytes = build_descriptor(d, kStringDescriptor, index);
  std::string text;
  for (std::size_t i = 2; i < bytes.size(); i += 2) text += static_cast<char>(bytes[i]);
  return text;
}

/// Requests a descriptor from a plugged arm, as a host does.
std::vector<std::byte> asked(const char* name, std::uint8_t request_type, std::uint8_t kind,
                             std::uint16_t index) {
  auto arm = make_usb_arm(name, {});
  EXPECT_TRUE(arm.ok());
  FaultyDevice plug(**arm);
  UsbipServer server(plug, "1-1");
  support::UsbHost host(server);
  EXPECT_TRUE(host.import_device());
  const auto done = host.control({.request_type = request_type,
                                  .request = 6,
                                  .value = static_cast<std::uint16_t>(kind << 8),
                                  .index = index,
                                  .length = 512});
  return done && done->status == 0 ? done->data : std::vector<std::byte>();
}

// mbed USBHID.cpp, reportDesc: page 0xffab, usage 0x0200, bytes of 0 to 255.
std::vector<std::byte> raw_reports(unsigned in, unsigned out) {
  return bytes_of({0x06, 0xab, 0xff, 0x0a, 0x00, 0x02, 0xa1, 0x01, 0x75, 0x08,
                   0x15, 0x00, 0x26, 0xff, 0x00, 0x95, in,   0x09, 0x01, 0x81,
                   0x02, 0x95, out,  0x09, 0x02, 0x91, 0x02, 0xc0});
}

class MbedBoard : public testing::TestWithParam<std::pair<const char*, unsigned>> {};

TEST_P(MbedBoard, DescriptorsMatchTheUsbHidClass) {
  const auto [name, size] = GetParam();
  EXPECT_EQ(
      asked(name, 0x80, kDeviceDescriptor, 0),
      bytes_of({18, 1, 0x00, 0x02, 0, 0, 0, 64, 0x34, 0x12, 0x06, 0x00, 0x01, 0x00, 1, 2, 3, 1}));
  EXPECT_EQ(asked(name, 0x80, kConfigurationDescriptor, 0),
            bytes_of({9, 2,    41,   0,    1,  1, 0,    0xc0, 0,  // configuration
                      9, 4,    0,    0,    2,  3, 0,    0,    0,  // interface
                      9, 0x21, 0x11, 0x01, 0,  1, 0x22, 28,   0,  // HID
                      7, 5,    0x81, 3,    64, 0, 1,              // reports
                      7, 5,    0x01, 3,    64, 0, 1}));           // messages
  EXPECT_EQ(asked(name, 0x81, kReportDescriptor, 0), raw_reports(size, size));
  EXPECT_TRUE(asked(name, 0x81, kReportDescriptor, 1).empty());
  const UsbDescription d = mbed_hid_description(static_cast<std::uint8_t>(size), {});
  EXPECT_EQ(text_of(d, 1), "mbed.org");
  EXPECT_EQ(text_of(d, 2), "HID DEVICE");
  EXPECT_EQ(text_of(d, 3), "0123456789");
}

INSTANTIATE_TEST_SUITE_P(Boards, MbedBoard,
                         testing::Values(std::pair("woodenhaptics", 8U), std::pair("polhem", 14U)),
                         [](const auto& param_info) {
                           return std::string(param_info.param.first);
                         });

TEST(TeensyBoard, DescriptorsMatchRawHid) {
  const char* const name = "polhem-64";
  EXPECT_EQ(
      asked(name, 0x80, kDeviceDescriptor, 0),
      bytes_of({18, 1, 0x00, 0x02, 0, 0, 0, 64, 0xc0, 0x16, 0x86, 0x04, 0x00, 0x01, 1, 2, 3, 1}));
  EXPECT_EQ(asked(name, 0x80, kConfigurationDescriptor, 0),
            bytes_of({9, 2,    73,   0,    2,  1, 0,    0xc0, 50,  // configuration
                      9, 4,    0,    0,    2,  3, 0,    0,    0,   // raw HID
                      9, 0x21, 0x11, 0x01, 0,  1, 0x22, 28,   0,   //
                      7, 5,    0x83, 3,    64, 0, 1,               // reports
                      7, 5,    0x04, 3,    64, 0, 1,               // messages
                      9, 4,    1,    0,    2,  3, 0,    0,    0,   // seremu
                      9, 0x21, 0x11, 0x01, 0,  1, 0x22, 33,   0,   //
                      7, 5,    0x81, 3,    64, 0, 1,               // debug output
                      7, 5,    0x02, 3,    32, 0, 2}));            // debug input
  EXPECT_EQ(asked(name, 0x81, kReportDescriptor, 0), raw_reports(64, 64));
  EXPECT_EQ(asked(name, 0x81, kReportDescriptor, 1),
            bytes_of({0x06, 0xc9, 0xff, 0x09, 0x04, 0xa1, 0x5c, 0x75, 0x08, 0x15, 0x00,
                      0x26, 0xff, 0x00, 0x95, 64,   0x09, 0x75, 0x81, 0x02, 0x95, 32,
                      0x09, 0x76, 0x91, 0x02, 0x95, 4,    0x09, 0x76, 0xb1, 0x02, 0xc0}));
  EXPECT_EQ(asked(name, 0x81, kHidDescriptor, 1), bytes_of({9, 0x21, 0x11, 1, 0, 1, 0x22, 33, 0}));
  const UsbDescription d = teensy_raw_hid_description({});
  EXPECT_EQ(text_of(d, 1), "Teensyduino");
  EXPECT_EQ(text_of(d, 2), "Teensyduino RawHID");
  const std::string serial = text_of(d, 3);
  EXPECT_FALSE(serial.empty());
  EXPECT_TRUE(
      std::all_of(serial.begin(), serial.end(), [](char c) { return c >= '0' && c <= '9'; }));
}

TEST(BoardDescriptions, UseTheRequestedSerialNumber) {
  EXPECT_EQ(text_of(mbed_hid_description(8, "77"), 3), "77");
  EXPECT_EQ(text_of(teensy_raw_hid_description("78"), 3), "78");
  EXPECT_EQ(text_of(falcon_description("79"), 3), "79");
}

}  // namespace
}  // namespace thimble::device_sim::usb
