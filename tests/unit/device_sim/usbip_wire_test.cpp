#include "usb/usbip_wire.h"
#include "usb/usb_description.h"

#include <gtest/gtest.h>

#include <random>
#include <string_view>

#include "support/long_form.h"
#include "support/seed.h"

namespace thimble::device_sim::usb {
namespace {

std::vector<std::byte> from_hex(std::string_view text) {
  std::vector<std::byte> bytes;
  std::string digits;
  for (const char letter : text) {
    if (letter == ' ') continue;
    digits += letter;
    if (digits.size() < 2) continue;
    bytes.push_back(static_cast<std::byte>(std::stoi(digits, nullptr, 16)));
    digits.clear();
  }
  return bytes;
}

UsbipCommand some_command(std::mt19937_64& random) {
  UsbipCommand command;
  command.sequence = static_cast<std::uint32_t>(random());
  command.device = static_cast<std::uint32_t>(random());
  command.kind = random() % 4 == 0 ? UsbipCommand::Kind::kUnlink : UsbipCommand::Kind::kSubmit;
  if (command.kind == UsbipCommand::Kind::kUnlink) {
    command.unlinked = static_cast<std::uint32_t>(random());
    command.size = kUsbipHeaderSize;
    return command;
  }
  command.to_host = random() % 2 == 0;
  command.endpoint = static_cast<std::uint8_t>(random() % 16);
  command.length = static_cast<std::uint32_t>(random() % 200);
  for (std::byte& byte : command.setup) byte = static_cast<std::byte>(random());
  command.size = kUsbipHeaderSize + (command.to_host ? 0 : command.length);
  return command;
}

TEST(UsbipWire, ReadsTheExampleOfTheKernelsDocumentation) {
  // Linux, Documentation/usb/usbip_protocol.rst, CmdIntrIN of the captured example.
  const auto bytes = from_hex(
      "00000001 00000d05 0001000f 00000001 00000001 00000200 00000040 ffffffff 00000000 00000004 "
      "00000000 00000000");
  // The example sets the number of packets to 0 and the start frame to -1.
  UsbipCommand command;
  ASSERT_EQ(decode_command(bytes, command), Decode::kWhole);
  EXPECT_EQ(command.sequence, 0xd05U);
  EXPECT_EQ(command.device, 0x1000fU);
  EXPECT_TRUE(command.to_host);
  EXPECT_EQ(command.endpoint, 1);
  EXPECT_EQ(command.length, 64U);
  EXPECT_EQ(command.size, kUsbipHeaderSize);
}

TEST(UsbipWire, DecodesEveryCommandFromAnyPieces) {
  std::mt19937_64 random(support::seed_of(1));
  for (int i = 0; i < 300; ++i) {
    const UsbipCommand sent = some_command(random);
    const std::vector<std::byte> data(sent.to_host ? 0 : sent.length, std::byte{0x5a});
    const std::vector<std::byte> bytes = encode_command(sent, data);
    ASSERT_EQ(bytes.size(), sent.size);
    UsbipCommand read;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      ASSERT_EQ(decode_command(std::span(bytes).first(size), read), Decode::kPartial) << size;
    }
    ASSERT_EQ(decode_command(bytes, read), Decode::kWhole);
    EXPECT_EQ(read.kind, sent.kind);
    EXPECT_EQ(read.sequence, sent.sequence);
    EXPECT_EQ(read.device, sent.device);
    EXPECT_EQ(read.to_host, sent.to_host);
    EXPECT_EQ(read.endpoint, sent.endpoint);
    EXPECT_EQ(read.length, sent.length);
    EXPECT_EQ(read.unlinked, sent.unlinked);
    EXPECT_EQ(read.setup, sent.setup);
    EXPECT_EQ(read.size, sent.size);
  }
}

TEST(UsbipWire, RefusesUnsupportedCommands) {
  UsbipCommand command;
  command.length = kTransferMax + 1;
  EXPECT_EQ(decode_command(encode_command(command), command), Decode::kInvalid);
  command = {};
  command.endpoint = 16;
  EXPECT_EQ(decode_command(encode_command(command), command), Decode::kInvalid);
  std::vector<std::byte> isochronous = encode_command({});
  isochronous[35] = std::byte{3};
  isochronous[32] = isochronous[33] = isochronous[34] = std::byte{0};
  EXPECT_EQ(decode_command(isochronous, command), Decode::kInvalid);
}

TEST(UsbipWire, LaysOutListAndImportAsDocumented) {
  UsbDescription device;
  device.vendor_id = 0x1234;
  device.product_id = 0x0006;
  device.release = 0x0102;
  device.interfaces.resize(2);
  device.interfaces[0].interface_class = 3;
  device.interfaces[1].interface_class = 7;
  const auto list = encode_list(&device, "1-1");
  ASSERT_EQ(list.size(), 0x0cU + 0x138U + 2 * 4U);
  EXPECT_EQ(list[11], std::byte{1});         // one device
  EXPECT_EQ(list[0x10c], std::byte{'1'});    // bus id
  EXPECT_EQ(list[0x134 + 3], std::byte{2});  // full speed
  EXPECT_EQ(list[0x138], std::byte{0x12});   // vendor
  EXPECT_EQ(list[0x13a + 1], std::byte{6});  // product
  EXPECT_EQ(list[0x143], std::byte{2});      // interfaces
  EXPECT_EQ(list[0x144], std::byte{3});      // class of the first
  EXPECT_EQ(list[0x148], std::byte{7});      // class of the second
  EXPECT_EQ(encode_list(nullptr, "1-1").size(), 12U);
  const auto import =
      encode_import(&device, std::string(99, 'x'));  // too long: truncated, still terminated
  ASSERT_EQ(import.size(), kImportReplySize);
  EXPECT_EQ(import[0x108 + kBusIdSize - 1], std::byte{0});
  EXPECT_EQ(encode_import(nullptr, "1-1").size(), kImportRefusalSize);
}

TEST(UsbipWire, SurvivesGarbageWithoutReadingBeyondIt) {
  std::mt19937_64 random(support::seed_of(7));
  const int rounds = support::long_form() ? 5'000'000 : 200'000;
  int whole = 0;
  for (int i = 0; i < rounds; ++i) {
    // A block of the exact size on the heap, so that the address sanitizer detects any access
    // beyond it.
    std::vector<std::byte> bytes = random() % 2 == 0 ? encode_command(some_command(random))
                                                     : std::vector<std::byte>(random() % 80);
    for (std::byte& byte : bytes) {
      if (random() % 12 == 0) byte = static_cast<std::byte>(random());
    }
    bytes.resize(std::min<std::size_t>(bytes.size(), random() % 300));
    bytes.shrink_to_fit();
    UsbipCommand command;
    if (decode_command(bytes, command) == Decode::kWhole) {
      ++whole;
      ASSERT_LE(command.size, bytes.size());
      ASSERT_LE(command.length, kTransferMax);
      ASSERT_LE(command.endpoint, 15);
    }
    UsbipRequest request;
    if (decode_request(bytes, request) == Decode::kWhole) {
      ASSERT_LE(request.size, bytes.size());
      ASSERT_LE(request.bus_id.size(), kBusIdSize);
    }
  }
  EXPECT_GT(whole, 0);
}

}  // namespace
}  // namespace thimble::device_sim::usb
