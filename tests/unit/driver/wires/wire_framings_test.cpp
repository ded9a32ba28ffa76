// Described wires with SLIP and with messages of variable length: tables, frames in a stream, and
// the mistakes that their descriptions can have.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/noise.h"
#include "support/random.h"
#include "transports/frame_finder.h"
#include "wires/slip.h"
#include "wires/wire_table.h"

namespace thimble::driver {
namespace {

using Bytes = std::vector<std::byte>;

Bytes bytes_of(std::initializer_list<int> values) {
  Bytes bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

WireFieldText field(WireItem item, WireType type, std::size_t at, std::size_t bytes) {
  WireFieldText text;
  text.name = "field at " + std::to_string(at);
  text.item = item;
  text.type = type;
  text.at = at;
  text.bytes = bytes;
  return text;
}

/// The frames of VESC boards: 02, length of the payload, payload, CRC-16 of the payload, 03
/// [S basti00/VescUartControl]. The payload is a kind, a number and a counter.
WireDescription vesc() {
  WireDescription wire;
  wire.transport = WireTransport::kSerial;
  for (WireLayoutText* layout : {&wire.report, &wire.command}) {
    layout->framing = WireFraming::kLength;
    layout->begin = bytes_of({0x02});
    layout->end = bytes_of({0x03});
    layout->size = 12;
    layout->length_at = 1;
    layout->length_adds = 5;
    layout->check = {
        .kind = WireCheck::kCrc16, .polynomial = 0x1021, .from = 2, .at = 9, .big_endian = true};
    layout->fields = {field(WireItem::kConstant, WireType::kUnsigned, 2, 1)};
    layout->fields[0].value = 4;
  }
  wire.report.fields.push_back(field(WireItem::kSequence, WireType::kUnsigned, 3, 1));
  wire.report.fields.push_back(field(WireItem::kEncoder, WireType::kSigned, 4, 4));
  wire.report.ignore = bytes_of({0x09});
  wire.command.fields.push_back(field(WireItem::kMotor, WireType::kSigned, 3, 2));
  wire.command.fields[1].scale = 0.001;
  return wire;
}

WireDescription slip() {
  WireDescription wire = vesc();
  for (WireLayoutText* layout : {&wire.report, &wire.command}) {
    layout->framing = WireFraming::kSlip;
    layout->length_at = layout->length_adds = 0;
    layout->begin.clear();
    layout->end.clear();
    layout->check.at = 10;
  }
  return wire;
}

WireTable table_of(const WireDescription& wire) {
  const WireCompiled result = compile_wire(wire);
  for (const WireMistake& mistake : result.mistakes) ADD_FAILURE() << mistake.sentence;
  return result.table ? *result.table : WireTable{};
}

std::string refusal_of(const WireDescription& wire) {
  std::string text;
  for (const WireMistake& mistake : compile_wire(wire).mistakes) text += mistake.sentence + '\n';
  return text;
}

Bytes report(const WireTable& wire, std::int32_t count, std::int64_t number = 0) {
  WireValues values;
  values.encoders[0] = count;
  values.sequence = number;
  std::array<std::byte, kReportCapacity> bytes{};
  const std::size_t size = wire.report.write(values, bytes);
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

/// Makes a message of a payload, as a VESC board sends it.
Bytes message(const Bytes& payload) {
  Bytes bytes = bytes_of({2, static_cast<int>(payload.size())});
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  const std::uint32_t crc =
      WireChecksum({.kind = WireCheck::kCrc16, .polynomial = 0x1021}).of(payload);
  bytes.push_back(static_cast<std::byte>(crc >> 8));
  bytes.push_back(static_cast<std::byte>(crc & 0xff));
  bytes.push_back(std::byte{3});
  return bytes;
}

/// Pushes bytes and returns the newest message.
Bytes push(FrameFinder& finder, const Bytes& bytes) {
  finder.push(bytes);
  std::array<std::byte, kReportCapacity> buffer{};
  std::uint32_t skipped = 0;
  const std::size_t size = finder.take(buffer, skipped);
  return {buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size)};
}

TEST(WireSlip, RoundTripsAndIsTotal) {
  support::Random random(72);
  for (int i = 0; i < 20'000; ++i) {
    auto content = support::any_bytes(random, random.bits() % (kWireSlipSizeMax + 1));
    for (std::byte& byte : content) {
      if (random.bits() % 3 == 0) byte = random.bits() % 2 == 0 ? kSlipEnd : kSlipEscape;
    }
    std::array<std::byte, kReportCapacity> stuffed{};
    const std::size_t size = put_slip(content, stuffed);
    EXPECT_EQ(
        std::count(stuffed.begin(), stuffed.begin() + static_cast<std::ptrdiff_t>(size), kSlipEnd),
        1);
    Bytes back(content.size());
    ASSERT_TRUE(take_slip(std::span(stuffed).first(size), back));
    EXPECT_EQ(back, content);
    (void)take_slip(support::any_bytes(random, random.bits() % 129), back);
  }
}

TEST(WireSlip, BytesAreThoseOfTheStandard) {
  std::array<std::byte, 16> stuffed{};
  const std::size_t size = put_slip(bytes_of({1, 0xc0, 0xdb, 2}), stuffed);
  EXPECT_EQ(Bytes(stuffed.begin(), stuffed.begin() + static_cast<std::ptrdiff_t>(size)),
            bytes_of({1, 0xdb, 0xdc, 0xdb, 0xdd, 2, 0xc0}));
}

TEST(WireSlip, OtherEscapesAreRefused) {
  Bytes back(1);
  EXPECT_TRUE(take_slip(bytes_of({0xdb, 0xdc, 0xc0}), back));
  for (const auto& bad : {bytes_of({0xdb, 0x01, 0xc0}), bytes_of({0xdb, 0xc0}),
                          bytes_of({0xc0, 0x01, 0xc0}), bytes_of({1, 2, 0xc0}), bytes_of({0xc0})}) {
    EXPECT_FALSE(take_slip(bad, back));
  }
}

TEST(WireSlip, ReportsAreFoundInAStream) {
  const WireTable wire = table_of(slip());
  FrameFinder finder({.described = &wire.report});
  const Bytes good = report(wire, 0x00c0dbc0);
  EXPECT_EQ(push(finder, bytes_of({7, 7, 0xc0})), Bytes());  // may have lost its beginning
  EXPECT_EQ(push(finder, bytes_of({0xc0, 0xc0})), Bytes());  // nothing between two ends
  EXPECT_EQ(push(finder, good), good);
  WireValues values;
  ASSERT_TRUE(wire.report.read(good, values));
  EXPECT_EQ(values.encoders[0], 0x00c0dbc0);
  EXPECT_EQ(push(finder, bytes_of({9, 1, 0xc0})), Bytes());  // to ignore
}

TEST(WireSlip, MistakesAreNamed) {
  WireDescription longer = slip();
  longer.report.size = 64;
  EXPECT_NE(refusal_of(longer).find("at most 63 bytes with framing: slip, found 64"),
            std::string::npos);
  WireDescription ignored = slip();
  ignored.report.ignore = bytes_of({0xc0});
  EXPECT_NE(refusal_of(ignored).find("must not contain c0 or db"), std::string::npos);
  WireDescription hid = slip();
  hid.transport = WireTransport::kHid;
  EXPECT_NE(refusal_of(hid).find("framing: slip needs transport: serial"), std::string::npos);
}

TEST(WireLength, MessageIsThatOfTheBoard) {
  const WireTable wire = table_of(vesc());
  EXPECT_EQ(report(wire, -2, 5), message(bytes_of({4, 5, 0xfe, 0xff, 0xff, 0xff, 0})));
}

TEST(WireLength, LongerMessagesAreReadAndShorterRefused) {
  const WireTable wire = table_of(vesc());
  WireValues values;
  ASSERT_TRUE(wire.report.read(message(bytes_of({4, 5, 7, 0, 0, 0, 1, 2, 3, 4})), values));
  EXPECT_EQ(values.encoders[0], 7);
  EXPECT_EQ(wire.report.read(message(bytes_of({4, 5, 7, 0, 0, 0})), values).flaw, WireFlaw::kSize);
}

TEST(WireLength, WrongLengthEndAndCheckValueAreRefused) {
  const WireTable wire = table_of(vesc());
  const Bytes good = report(wire, 1);
  WireValues values;
  const auto flaw = [&](std::size_t at) {
    Bytes bad = good;
    bad[at] ^= std::byte{1};
    return wire.report.read(bad, values).flaw;
  };
  EXPECT_EQ(flaw(1), WireFlaw::kSize);
  EXPECT_EQ(flaw(4), WireFlaw::kCheck);
  EXPECT_EQ(flaw(10), WireFlaw::kCheck);
  EXPECT_EQ(flaw(11), WireFlaw::kMark);
}

TEST(WireLength, MessagesOfAnyLengthAreFoundInAStream) {
  const WireTable wire = table_of(vesc());
  FrameFinder finder({.described = &wire.report});
  support::Random random(73);
  for (int i = 0; i < 5000; ++i) {
    Bytes payload = support::any_bytes(random, 7 + random.bits() % 100);
    payload[0] = std::byte{4};
    // Noise without the first byte of a message, so that no false one can begin in it.
    Bytes stream = support::any_bytes(random, random.bits() % 9);
    for (std::byte& byte : stream) {
      if (byte == std::byte{2}) byte = std::byte{1};
    }
    const Bytes good = message(payload);
    stream.insert(stream.end(), good.begin(), good.end());
    ASSERT_EQ(push(finder, stream), good) << i;
  }
  EXPECT_EQ(finder.torn(), 0u);
}

TEST(WireLength, FalseBeginningDelaysButDropsNoMessage) {
  const WireTable wire = table_of(vesc());
  FrameFinder finder({.described = &wire.report});
  std::uint64_t sent = 0;
  finder.push(bytes_of({2, 60}));  // promises 65 bytes
  for (; sent < 6; ++sent) finder.push(report(wire, 1, static_cast<std::int64_t>(sent)));
  EXPECT_EQ(finder.found(), sent);
  EXPECT_GE(finder.torn(), 1u);
}

TEST(WireLength, ShorterAndIgnoredMessagesAreNoReports) {
  const WireTable wire = table_of(vesc());
  FrameFinder finder({.described = &wire.report});
  EXPECT_EQ(push(finder, message(bytes_of({1, 2, 3}))), Bytes());
  EXPECT_EQ(push(finder, message(bytes_of({9, 0, 0, 0, 0, 0, 0, 0, 0}))), Bytes());
  EXPECT_EQ(finder.torn(), 0u);
  EXPECT_EQ(push(finder, report(wire, 3)), report(wire, 3));
}

TEST(WireLength, AnyBytesArePutInOrRefused) {
  const WireTable wires[] = {table_of(vesc()), table_of(slip())};
  support::Random random(74);
  for (const WireTable& wire : wires) {
    FrameFinder finder({.described = &wire.report});
    int valid = 0;
    for (int i = 0; i < 20'000; ++i) {
      Bytes stream = support::any_bytes(random, random.bits() % 300);
      for (std::byte& byte : stream) {
        if (random.bits() % 8 == 0) byte = std::byte{2};
      }
      stream.push_back(kSlipEnd);
      const Bytes good = support::damaged(random, report(wire, i, i));
      stream.insert(stream.end(), good.begin(), good.end());
      const Bytes found = push(finder, stream);
      WireValues values;
      valid += wire.report.read(found, values) ? 1 : 0;
    }
    EXPECT_GT(valid, 500);
  }
}

TEST(WireLength, MistakesNameKeyFieldAndByte) {
  WireDescription overlap = vesc();
  overlap.report.fields[1].at = 1;
  EXPECT_NE(refusal_of(overlap).find("field at 3: byte 1 overlap the byte with the length"),
            std::string::npos)
      << refusal_of(overlap);
  WireDescription before = vesc();
  before.report.length_at = 0;
  EXPECT_NE(refusal_of(before).find("length_at: byte 0 overlaps begin"), std::string::npos);
  WireDescription behind = vesc();
  behind.command.length_at = 9;
  EXPECT_NE(refusal_of(behind).find("command: length_at: byte 9 is not before the checksum"),
            std::string::npos);
  WireDescription adds = vesc();
  adds.report.length_adds = 13;
  EXPECT_NE(refusal_of(adds).find("length_adds: expected at most size, 12 bytes, found 13"),
            std::string::npos);
  WireDescription check = vesc();
  check.report.check.at = 8;
  EXPECT_NE(refusal_of(check).find("checksum_at: cannot be used with framing: length"),
            std::string::npos);
  WireDescription fixed = vesc();
  fixed.report.framing = WireFraming::kHeader;
  EXPECT_NE(refusal_of(fixed).find("length_at and length_adds need framing: length"),
            std::string::npos);
}

/// The VESC wire with an unsigned counter of 16 bits that wraps.
WireDescription wrapping(int bits) {
  WireDescription wire = vesc();
  wire.report.fields[2] = field(WireItem::kEncoder, WireType::kUnsigned, 4, 2);
  wire.report.fields[2].wrap = bits;
  return wire;
}

TEST(WireWrap, CounterIsReadWithItsSign) {
  const WireTable wire = table_of(wrapping(12));
  EXPECT_TRUE(wire.wraps);
  EXPECT_EQ(wire.wrap, (std::array<std::uint8_t, 3>{12, 0, 0}));
  for (const auto& [count, raw] : {std::pair(-1, -1), {2047, 2047}, {2048, -2048}, {4096, 0}}) {
    WireValues values;
    ASSERT_TRUE(wire.report.read(report(wire, count), values));
    EXPECT_EQ(values.encoders[0], raw) << count;
  }
  // Bits above the counter are not part of it.
  WireValues values;
  ASSERT_TRUE(wire.report.read(message(bytes_of({4, 0, 0x00, 0x78, 0, 0, 0})), values));
  EXPECT_EQ(values.encoders[0], -2048);
}

TEST(WireWrap, MistakesNameFieldAndByte) {
  EXPECT_NE(refusal_of(wrapping(17))
                .find("field at 4: wrap: bytes 4 to 5 have 16 bits for the counter, fewer than 17"),
            std::string::npos)
      << refusal_of(wrapping(17));
  EXPECT_NE(refusal_of(wrapping(7)).find("wrap: expected from 8 to 31 bits, found 7"),
            std::string::npos);
  WireDescription scaled = wrapping(12);
  scaled.report.fields[2].scale = 2;
  EXPECT_NE(refusal_of(scaled).find("wrap: needs an integer type, scale 1 and offset 0"),
            std::string::npos);
  WireDescription motor = vesc();
  motor.command.fields[1].wrap = 12;
  EXPECT_NE(refusal_of(motor).find("field at 3: wrap: needs an encoder"), std::string::npos);
}

}  // namespace
}  // namespace thimble::driver
