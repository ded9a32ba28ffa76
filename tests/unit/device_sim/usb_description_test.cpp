#include "usb/usb_description.h"

#include <gtest/gtest.h>

#include "support/boards/shelf_entry.h"
#include "usb/hid_arm.h"

namespace thimble::device_sim::usb {
namespace {

unsigned at(const std::vector<std::byte>& bytes, std::size_t i) {
  return std::to_integer<unsigned>(bytes.at(i));
}

// Parses the short items of a report descriptor (HID 1.11, 6.2.2). Sums the bits of all inputs and
// outputs, and returns whether collections and items are closed.
struct ReportSizes {
  unsigned in_bits = 0, out_bits = 0;
  bool well_formed = false;
};

ReportSizes read_report_descriptor(const std::vector<std::byte>& bytes) {
  ReportSizes sizes;
  unsigned report_size = 0, report_count = 0;
  int depth = 0;
  std::size_t i = 0;
  while (i < bytes.size()) {
    const unsigned prefix = at(bytes, i);
    const std::size_t length = (prefix & 3U) == 3 ? 4 : prefix & 3U;
    if (i + 1 + length > bytes.size()) return sizes;
    unsigned value = 0;
    for (std::size_t k = length; k-- > 0;) value = (value << 8) | at(bytes, i + 1 + k);
    switch (prefix & 0xfcU) {
      case 0x74:
        report_size = value;
        break;
      case 0x94:
        report_count = value;
        break;
      case 0x80:
        sizes.in_bits += report_size * report_count;
        break;
      case 0x90:
        sizes.out_bits += report_size * report_count;
        break;
      case 0xa0:
        ++depth;
        break;
      case 0xc0:
        if (--depth < 0) return sizes;
        break;
      default:
        break;
    }
    i += 1 + length;
  }
  sizes.well_formed = depth == 0;
  return sizes;
}

class EveryArm : public testing::TestWithParam<ShelfEntry> {
 protected:
  void SetUp() override {
    auto made = make_usb_arm(GetParam().name, {});
    ASSERT_TRUE(made.ok()) << made.error().message;
    arm_ = std::move(*made);
  }
  std::unique_ptr<UsbArm> arm_;
};

TEST_P(EveryArm, DescriptorsAreConsistent) {
  const UsbDescription& d = arm_->description();
  const auto device = build_descriptor(d, kDeviceDescriptor, 0);
  ASSERT_EQ(device.size(), 18U);
  EXPECT_EQ(at(device, 0), 18U);
  EXPECT_EQ(at(device, 8) | (at(device, 9) << 8), d.vendor_id);
  EXPECT_EQ(at(device, 10) | (at(device, 11) << 8), d.product_id);

  const auto configuration = build_descriptor(d, kConfigurationDescriptor, 0);
  ASSERT_EQ(at(configuration, 2) | (at(configuration, 3) << 8), configuration.size());
  std::size_t i = 0;
  unsigned interfaces = 0, endpoints = 0, endpoints_promised = 0, hid_report_size = 0;
  std::size_t reports_of_all = 0;
  for (const InterfaceDescription& interface : d.interfaces) {
    reports_of_all += interface.report_descriptor.size();
  }
  while (i < configuration.size()) {
    ASSERT_GE(at(configuration, i), 2U);
    switch (at(configuration, i + 1)) {
      case kInterfaceDescriptor:
        EXPECT_EQ(at(configuration, i + 2), interfaces);
        ++interfaces;
        endpoints_promised += at(configuration, i + 4);
        break;
      case kEndpointDescriptor:
        ++endpoints;
        EXPECT_NE(d.endpoint(static_cast<std::uint8_t>(at(configuration, i + 2))), nullptr);
        EXPECT_LE(at(configuration, i + 4), 64U);
        break;
      case kHidDescriptor:
        hid_report_size += at(configuration, i + 7) | (at(configuration, i + 8) << 8);
        break;
      default:
        break;
    }
    i += at(configuration, i);
  }
  EXPECT_EQ(i, configuration.size());
  EXPECT_EQ(interfaces, at(configuration, 4));
  EXPECT_EQ(endpoints, endpoints_promised);
  EXPECT_EQ(hid_report_size, reports_of_all);
  EXPECT_EQ(interfaces, d.interfaces.size());
}

TEST_P(EveryArm, HasAllPromisedStrings) {
  const UsbDescription& d = arm_->description();
  const auto device = build_descriptor(d, kDeviceDescriptor, 0);
  for (const std::size_t field : {14U, 15U, 16U}) {
    const auto index = static_cast<std::uint8_t>(at(device, field));
    ASSERT_NE(index, 0) << field;
    const auto text = build_descriptor(d, kStringDescriptor, index);
    ASSERT_GT(text.size(), 2U);
    EXPECT_EQ(at(text, 0), text.size());
  }
  EXPECT_TRUE(build_descriptor(d, kStringDescriptor, 4).empty());
  EXPECT_EQ(build_descriptor(d, kStringDescriptor, 0).size(), 4U);
}

TEST_P(EveryArm, HasAReportDescriptorOfTheSizeOfItsReports) {
  const auto* hid = dynamic_cast<const HidArm*>(arm_.get());
  if (hid == nullptr) {
    EXPECT_TRUE(arm_->description().interfaces[0].report_descriptor.empty());
    return;
  }
  const ReportSizes sizes =
      read_report_descriptor(arm_->description().interfaces[0].report_descriptor);
  EXPECT_TRUE(sizes.well_formed);
  EXPECT_EQ(sizes.in_bits, 8 * hid->report_size());
  EXPECT_EQ(sizes.out_bits, 8 * hid->report_size());
}

INSTANTIATE_TEST_SUITE_P(Shelf, EveryArm, testing::ValuesIn(kShelf), [](const auto& param_info) {
  std::string name(param_info.param.name);
  for (char& letter : name) {
    if (letter == '-') letter = '_';
  }
  return name;
});

TEST(UsbDescription, CutsStringsThatDoNotFit) {
  UsbDescription d;
  d.product = std::string(1000, 'x');
  const auto text = build_descriptor(d, kStringDescriptor, 2);
  EXPECT_EQ(text.size(), 254U);
  EXPECT_EQ(at(text, 0), 254U);
}

TEST(ArmShelf, UnknownNameListsTheKnownArms) {
  const auto made = make_usb_arm("excalibur", {});
  ASSERT_FALSE(made.ok());
  for (const ShelfEntry& entry : kShelf) {
    EXPECT_NE(made.error().message.find(entry.name), std::string::npos) << entry.name;
  }
}

}  // namespace
}  // namespace thimble::device_sim::usb
