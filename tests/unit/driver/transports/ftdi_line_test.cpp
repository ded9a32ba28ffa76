#include "transports/ftdi_line.h"

#include <gtest/gtest.h>
#include <libusb-1.0/libusb.h>

#include <array>
#include <string>

#include "support/mock/fake_libusb.h"

namespace thimble::driver {
namespace {

class FtdiLineTest : public ::testing::Test {
 protected:
  void SetUp() override { usb_.reset(); }

  support::FakeLibusb& usb_ = support::fake_libusb();
};

TEST_F(FtdiLineTest, RemovesTheStatusBytes) {
  const auto line = FtdiLine::open({.bus = 1, .device = 7});
  ASSERT_TRUE(line) << line.error().message;
  std::array<std::byte, 4> bytes{};
  const auto text = [&](int count) {
    return std::string(reinterpret_cast<const char*>(bytes.data()),
                       static_cast<std::size_t>(count));
  };
  EXPECT_EQ((*line)->read(bytes, 5), 0);  // nothing received
  usb_.say("");                           // only the status bytes, as in each latency period
  usb_.say("abcdef");
  EXPECT_EQ(text((*line)->read(bytes, 5)), "abcd");
  EXPECT_EQ(text((*line)->read(bytes, 5)), "ef");
  usb_.read_code = LIBUSB_ERROR_NO_DEVICE;
  EXPECT_EQ((*line)->read(bytes, 5), -1);
}

TEST_F(FtdiLineTest, FlushFailsIfTheConverterRefuses) {
  const auto line = FtdiLine::open({.bus = 1, .device = 7});
  ASSERT_TRUE(line) << line.error().message;
  std::array<std::byte, 2> bytes{};
  usb_.say("abcdef");
  EXPECT_EQ((*line)->read(bytes, 5), 2);
  EXPECT_TRUE((*line)->purge());
  EXPECT_EQ((*line)->read(bytes, 5), 0);
  for (const int refused : {0, 1}) {
    usb_.requests_refused[0] = usb_.control_requests + refused;
    EXPECT_FALSE((*line)->purge()) << refused;
  }
}

}  // namespace
}  // namespace thimble::driver
