#include "transports/hid_descriptor.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/boards/raw_hid.h"
#include "support/random.h"

namespace thimble::driver {
namespace {

template <class Bytes>
HidReports read(const Bytes& bytes) {
  return read_hid_descriptor(std::as_bytes(std::span(bytes)));
}

TEST(HidDescriptor, ReadsPageUsageAndLengthsOfRawHid) {
  const HidReports reports = read(support::raw_hid_descriptor(14, 8));
  EXPECT_EQ(reports, (HidReports{.usage_page = 0xffab,
                                 .usage = 0x0200,
                                 .in_bytes = 14,
                                 .out_bytes = 8,
                                 .numbered = false}));
  EXPECT_FALSE(is_raw_hid(reports, 14));
  EXPECT_FALSE(is_raw_hid(reports, 8));
  EXPECT_TRUE(is_raw_hid(read(support::raw_hid_descriptor(64, 64)), 64));
  EXPECT_FALSE(is_raw_hid(read(support::raw_hid_descriptor(64, 64, 0xffc9)), 64));
}

TEST(HidDescriptor, SumsTheFieldsOfAKeyboardAndKeepsItsOuterUsage) {
  // The boot keyboard [HID 1.11, appendix B]: 8 bits, 8 bits, 6 bytes in; 5 + 3 bits out.
  const std::vector<unsigned char> keyboard = {
      0x05, 0x01, 0x09, 0x06, 0xa1, 0x01, 0x05, 0x07, 0x19, 0xe0, 0x29, 0xe7, 0x75, 0x01, 0x95,
      0x08, 0x81, 0x02, 0x95, 0x01, 0x75, 0x08, 0x81, 0x01, 0x95, 0x05, 0x75, 0x01, 0x91, 0x02,
      0x95, 0x01, 0x75, 0x03, 0x91, 0x01, 0x95, 0x06, 0x75, 0x08, 0x81, 0x00, 0xc0};
  const HidReports reports = read(keyboard);
  EXPECT_EQ(reports.usage_page, 1);
  EXPECT_EQ(reports.usage, 6);
  EXPECT_EQ(reports.in_bytes, 8u);
  EXPECT_EQ(reports.out_bytes, 1u);
}

TEST(HidDescriptor, KeepsTheUsageOfTheOuterCollection) {
  const std::vector<unsigned char> nested = {
      0x06, 0xab, 0xff, 0x0a, 0x00, 0x02, 0xa1, 0x01,  // page ffab, usage 0200: a collection
      0x05, 0x01, 0x09, 0x06, 0xa1, 0x02,              // page 1, usage 6: a nested collection
      0x75, 0x08, 0x95, 0x08, 0x81, 0x02, 0xc0, 0xc0};
  EXPECT_EQ(read(nested).usage_page, 0xffab);
  EXPECT_EQ(read(nested).usage, 0x0200);
  EXPECT_EQ(read(nested).in_bytes, 8u);
}

TEST(HidDescriptor, ReportNumberBeforeTheCollectionChangesNoUsage) {
  const std::vector<unsigned char> numbered = {0x85, 0x01,  // report 1
                                               0x06, 0xab, 0xff, 0x0a, 0x00, 0x02, 0xa1,
                                               0x01,  // page ffab, usage 0200: a collection
                                               0x75, 0x08, 0x95, 0x08, 0x81, 0x02, 0xc0};
  EXPECT_EQ(
      read(numbered),
      (HidReports{
          .usage_page = 0xffab, .usage = 0x0200, .in_bytes = 8, .out_bytes = 0, .numbered = true}));
}

TEST(HidDescriptor, PassesOverALongItemAndReadsOn) {
  // A long item of three bytes [HID 1.11, 6.2.2.3], then eight bytes in.
  const std::vector<unsigned char> with_long = {0xfe, 0x03, 0xf0, 0x81, 0x81, 0x81,
                                                0x75, 0x08, 0x95, 0x08, 0x81, 0x02};
  EXPECT_EQ(read(with_long).in_bytes, 8u);
  const std::vector<unsigned char> torn = {0x75, 0x08, 0x95, 0x08, 0x81, 0x02, 0xfe, 0x09, 0xf0};
  EXPECT_EQ(read(torn).in_bytes, 8u);
}

TEST(HidDescriptor, DetectsNumberedReports) {
  const std::vector<unsigned char> numbered = {0x85, 0x01, 0x75, 0x08, 0x95, 0x08, 0x81, 0x02};
  EXPECT_TRUE(read(numbered).numbered);
}

TEST(HidDescriptor, AcceptsAnyBytesAndBoundsLengthsAt64KB) {
  support::Random random(16);
  for (int i = 0; i < 20'000; ++i) {
    std::vector<unsigned char> bytes(random.bits() % 64);
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random.bits());
    const HidReports reports = read(bytes);
    EXPECT_LE(reports.in_bytes, 1u << 16);
    EXPECT_LE(reports.out_bytes, 1u << 16);
  }
  // Lengths that would overflow: many items of 2^32 - 1 fields of 2^32 - 1 bits.
  std::vector<unsigned char> huge = {0x77, 0xff, 0xff, 0xff, 0xff, 0x97, 0xff, 0xff, 0xff, 0xff};
  for (int i = 0; i < 1000; ++i) huge.insert(huge.end(), {0x81, 0x02});
  EXPECT_EQ(read(huge).in_bytes, 1u << 16);
}

}  // namespace
}  // namespace thimble::driver
