// Tables of described wires: every representation in both directions, check values, total
// decoding, and the mistakes that a description can have.
#include "wires/wire_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "support/noise.h"
#include "support/random.h"
#include "wires/cobs.h"
#include "wires/decimal_text.h"

namespace thimble::driver {
namespace {

WireFieldText field(WireItem item, std::size_t axis, WireType type, std::size_t at,
                    std::size_t bytes) {
  WireFieldText text;
  text.name = "field at " + std::to_string(at);
  text.item = item;
  text.axis = axis;
  text.type = type;
  text.at = at;
  text.bytes = bytes;
  return text;
}

/// A wire with one field of each kind, with header and CRC.
WireDescription full_wire() {
  WireDescription wire;
  wire.transport = WireTransport::kSerial;
  WireLayoutText& report = wire.report;
  report.framing = WireFraming::kHeader;
  report.begin = {std::byte{0xaa}, std::byte{0x55}};
  report.size = 40;
  report.check = {.kind = WireCheck::kCrc16, .polynomial = 0x1021, .initial = 0xffff, .at = 38};
  report.fields = {field(WireItem::kEncoder, 0, WireType::kSigned, 2, 2),
                   field(WireItem::kEncoder, 1, WireType::kSigned, 4, 4),
                   field(WireItem::kEncoder, 2, WireType::kFloat, 8, 4),
                   field(WireItem::kGimbal, 0, WireType::kNibbles, 12, 4),
                   field(WireItem::kButtons, 0, WireType::kUnsigned, 16, 1),
                   field(WireItem::kErrors, 0, WireType::kUnsigned, 16, 1),
                   field(WireItem::kSequence, 0, WireType::kUnsigned, 17, 1),
                   field(WireItem::kTime, 0, WireType::kUnsigned, 18, 8),
                   field(WireItem::kTemperature, 0, WireType::kUnsigned, 26, 1),
                   field(WireItem::kConstant, 0, WireType::kUnsigned, 27, 2)};
  report.fields[1].big_endian = true;
  report.fields[2].scale = 100;
  report.fields[3].minus = 65;
  report.fields[4].bit_first = 0;
  report.fields[4].bit_last = 2;
  report.fields[4].inverted = true;
  report.fields[5].bit_first = 3;
  report.fields[5].bit_last = 7;
  report.fields[8].scale = 0.5;
  report.fields[8].offset = -20;
  report.fields[9].value = 0x1234;
  WireLayoutText& command = wire.command;
  command.framing = WireFraming::kHeader;
  command.begin = {std::byte{0xaa}};
  command.size = 12;
  command.check = {.kind = WireCheck::kXor8, .at = 11};
  for (std::size_t i = 0; i < 3; ++i) {
    command.fields.push_back(field(WireItem::kMotor, i, WireType::kSigned, 1 + 2 * i, 2));
    command.fields.back().scale = 0.001;
  }
  return wire;
}

WireCompiled compiled(WireDescription wire) {
  WireCompiled result = compile_wire(std::move(wire));
  for (const WireMistake& mistake : result.mistakes) ADD_FAILURE() << mistake.sentence;
  return result;
}

std::string mistakes_of(WireDescription wire) {
  std::string text;
  for (const WireMistake& mistake : compile_wire(std::move(wire)).mistakes) {
    text += mistake.sentence + '\n';
  }
  return text;
}

WireValues any_values(support::Random& random) {
  WireValues values;
  values.encoders = {support::any_word(random), static_cast<std::int32_t>(random.bits() >> 32),
                     100 * support::any_word(random)};
  values.gimbal = {support::any_word(random), 0, 0};
  values.buttons = static_cast<std::uint32_t>(random.bits() >> 61);
  values.errors = static_cast<std::uint32_t>(random.bits() >> 59);
  values.sequence = static_cast<std::int64_t>(random.bits() >> 56);
  values.time = static_cast<std::int64_t>(random.bits() >> 1);
  values.temperature = {0.5F * static_cast<float>(random.bits() >> 56) - 20, 0, 0};
  return values;
}

void expect_same(const WireValues& a, const WireValues& b) {
  EXPECT_EQ(a.encoders, b.encoders);
  EXPECT_EQ(a.gimbal, b.gimbal);
  EXPECT_EQ(a.buttons, b.buttons);
  EXPECT_EQ(a.errors, b.errors);
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.temperature, b.temperature);
}

TEST(WireTable, EveryRepresentationRoundTrips) {
  const auto wire = compiled(full_wire());
  ASSERT_TRUE(wire.table);
  support::Random random(53);
  for (int i = 0; i < 10'000; ++i) {
    const WireValues values = any_values(random);
    std::array<std::byte, kReportCapacity> bytes{};
    const std::size_t size = wire.table->report.write(values, bytes);
    WireValues back;
    ASSERT_TRUE(wire.table->report.read(std::span(bytes).first(size), back));
    expect_same(values, back);
  }
}

TEST(WireTable, BytesAreWhereTheDescriptionPutsThem) {
  const auto wire = compiled(full_wire());
  ASSERT_TRUE(wire.table);
  WireValues values;
  values.encoders = {0x0102, 0x01020304, 100};
  values.gimbal = {-2, 0, 0};
  values.buttons = 5;
  values.errors = 9;
  values.temperature = {30, 0, 0};
  std::array<std::byte, kReportCapacity> bytes{};
  ASSERT_EQ(wire.table->report.write(values, bytes), 40u);
  const std::array<int, 29> expected = {0xaa, 0x55, 0x02, 0x01, 1,   2,   3,    4,    0,   0,
                                        0x80, 0x3f, 'O',  'P',  'P', 'P', 0x4a, 0,    0,   0,
                                        0,    0,    0,    0,    0,   0,   100,  0x34, 0x12};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << "byte " << i;
  }
}

TEST(WireTable, CheckValuesAreThoseOfTheCatalogue) {
  const std::string digits = "123456789";
  const auto bytes = std::as_bytes(std::span(digits));
  const auto of = [&](WireCheck kind, std::uint32_t polynomial, std::uint32_t initial,
                      std::uint32_t final_xor, bool reflected) {
    return WireChecksum({.kind = kind,
                         .polynomial = polynomial,
                         .initial = initial,
                         .final_xor = final_xor,
                         .reflected = reflected})
        .of(bytes);
  };
  EXPECT_EQ(of(WireCheck::kCrc8, 0x07, 0, 0, false), 0xf4u);
  EXPECT_EQ(of(WireCheck::kCrc16, 0x1021, 0xffff, 0, false), 0x29b1u);
  EXPECT_EQ(of(WireCheck::kCrc16, 0x1021, 0, 0, false), 0x31c3u);
  EXPECT_EQ(of(WireCheck::kCrc16, 0x8005, 0xffff, 0, true), 0x4b37u);
  EXPECT_EQ(of(WireCheck::kCrc32, 0x04c11db7, 0xffffffff, 0xffffffff, true), 0xcbf43926u);
  EXPECT_EQ(of(WireCheck::kSum8, 0, 0, 0, false), 0xddu);
  EXPECT_EQ(of(WireCheck::kXor8, 0, 0, 0, false), 0x31u);
}

TEST(WireTable, DecodesOrRejectsAnyBytes) {
  const auto wire = compiled(full_wire());
  ASSERT_TRUE(wire.table);
  support::Random random(54);
  int valid = 0;
  for (int i = 0; i < 200'000; ++i) {
    std::array<std::byte, kReportCapacity> bytes{};
    const std::size_t size = wire.table->report.write(any_values(random), bytes);
    const auto damaged = support::damaged(random, {bytes.begin(), bytes.begin() + size});
    ArmReading reading{.counts = {1, 2, 3}};
    const bool good = wire.table->decode(damaged, reading);
    valid += good ? 1 : 0;
    if (!good) {
      EXPECT_EQ(reading.counts, (std::array{1, 2, 3}));
    }
  }
  // A check value of 16 bits misses one damage in 65,536; some damages change nothing.
  EXPECT_LT(valid, 2'000);
}

TEST(WireTable, ErrorFlagsMakeAReportUnusable) {
  WireDescription description = full_wire();
  description.report.fields[5].reject = 4;
  const auto wire = compiled(description);
  ASSERT_TRUE(wire.table);
  for (std::uint32_t errors = 0; errors < 8; ++errors) {
    WireValues values;
    values.errors = errors;
    std::array<std::byte, kReportCapacity> bytes{};
    const std::size_t size = wire.table->report.write(values, bytes);
    ArmReading reading;
    EXPECT_EQ(wire.table->decode(std::span(bytes).first(size), reading), (errors & 4) == 0);
  }
}

TEST(WireTable, MotorUnitsConvertCurrents) {
  WireDescription description = full_wire();
  description.command.fields[1].unit = WireUnit::kNewtonMetre;
  description.command.fields[2].unit = WireUnit::kDutyRoot;
  description.command.fields[2].full = 0.04;
  auto wire = *compiled(description).table;
  std::array<MotorDrive, 3> drives;
  drives.fill({.torque_constant = 0.02});
  wire.use_motors(drives);
  std::array<std::byte, kReportCapacity> bytes{};
  wire.encode({1, -1, -0.5}, bytes);
  const auto word = [&](std::size_t at) {
    std::int16_t value = 0;
    std::memcpy(&value, bytes.data() + at, 2);
    return value;
  };
  EXPECT_EQ(word(1), 1000);  // mA
  EXPECT_EQ(word(3), -20);   // mN m
  EXPECT_EQ(word(5), -500);  // root of 0.5 * 0.02 / 0.04
  WireValues back;
  ASSERT_TRUE(wire.command.read(std::span(bytes).first(12), back));
  EXPECT_NEAR(back.motors[1], -1, 1e-12);
  EXPECT_NEAR(back.motors[2], -0.5, 1e-12);
}

TEST(WireTable, CurrentsBeyondTheTypeSaturate) {
  const auto wire = compiled(full_wire());
  ASSERT_TRUE(wire.table);
  std::array<std::byte, kReportCapacity> bytes{};
  wire.table->encode({1000, -1000, 0}, bytes);
  EXPECT_EQ(std::to_integer<int>(bytes[2]), 0x7f);
  EXPECT_EQ(std::to_integer<int>(bytes[1]), 0xff);
  EXPECT_EQ(std::to_integer<int>(bytes[4]), 0x80);
  EXPECT_EQ(std::to_integer<int>(bytes[3]), 0x01);
}

TEST(WireTable, MistakesNameFieldAndByte) {
  WireDescription beyond = full_wire();
  beyond.report.fields[7].at = 33;
  EXPECT_NE(mistakes_of(beyond).find("field at 18: bytes 33 to 40 end beyond the message of 40"),
            std::string::npos);
  WireDescription overlap = full_wire();
  overlap.report.fields[1].at = 3;
  EXPECT_NE(mistakes_of(overlap).find("bytes 3 to 6 overlap field field at 2 (bytes 2 to 3)"),
            std::string::npos);
  WireDescription mark = full_wire();
  mark.report.fields[0].at = 1;
  EXPECT_NE(mistakes_of(mark).find("bytes 1 to 2 overlap begin"), std::string::npos);
  WireDescription check = full_wire();
  check.report.fields[9].at = 37;
  EXPECT_NE(mistakes_of(check).find("overlap the checksum"), std::string::npos);
  WireDescription twice = full_wire();
  twice.command.fields[1].axis = 0;
  EXPECT_NE(mistakes_of(twice).find("is described twice"), std::string::npos);
  WireDescription missing = full_wire();
  missing.command.fields.pop_back();
  EXPECT_NE(mistakes_of(missing).find("found 3 and 2"), std::string::npos);
  WireDescription stream = full_wire();
  stream.streams = true;
  stream.report.framing = WireFraming::kFixed;
  EXPECT_NE(mistakes_of(stream).find("fixed has no marks"), std::string::npos);
  WireDescription unsigned_motor = full_wire();
  unsigned_motor.command.fields[0].type = WireType::kUnsigned;
  EXPECT_NE(mistakes_of(unsigned_motor).find("needs an offset"), std::string::npos);
}

/// A wire whose first motor is an unsigned 16-bit value with an offset.
WireDescription offset_wire(double scale, double offset, double limit) {
  WireDescription wire = full_wire();
  WireFieldText& motor = wire.command.fields[0];
  motor.type = WireType::kUnsigned;
  motor.scale = scale;
  motor.offset = offset;
  motor.limit = limit;
  return wire;
}

TEST(WireTable, ZeroCurrentIsTheRawValueOfZero) {
  const WireCompiled wire = compiled(offset_wire(0.001, -32.768, 5));
  ASSERT_TRUE(wire.table);
  for (const auto& [current, raw] :
       {std::pair(0.0, 32768), {1.0, 33768}, {9.0, 37768}, {-9.0, 27768}}) {
    std::array<std::byte, kReportCapacity> bytes{};
    wire.table->encode({current, 0, 0}, bytes);
    EXPECT_EQ(std::to_integer<int>(bytes[1]) | std::to_integer<int>(bytes[2]) << 8, raw) << current;
  }
}

TEST(WireTable, RefusesAMotorThatCannotBeOff) {
  EXPECT_NE(mistakes_of(offset_wire(0.001, 1, 0)).find("on both sides of zero"), std::string::npos);
  EXPECT_NE(mistakes_of(offset_wire(0.003, -32, 0)).find("never be off"), std::string::npos);
  EXPECT_NE(mistakes_of(offset_wire(0.001, -32.768, 0.01)).find("20 steps"), std::string::npos);
}

TEST(WireTable, RefusesACheckValueWithinAMark) {
  WireDescription wire = full_wire();
  wire.report.end = {std::byte{0x0d}};
  EXPECT_NE(mistakes_of(wire).find("checksum: its bytes 38 to 39 overlap end"), std::string::npos);
  wire.report.end.clear();
  wire.report.check.at = 1;
  EXPECT_NE(mistakes_of(wire).find("checksum: its bytes 1 to 2 overlap begin"), std::string::npos);
}

TEST(WireTable, RefusesASequenceNumberOfFewBits) {
  WireDescription wire = full_wire();
  wire.report.fields[6].bit_first = 0;
  wire.report.fields[6].bit_last = 0;
  EXPECT_NE(mistakes_of(wire).find("at least 4 bits"), std::string::npos);
}

TEST(WireTable, CobsRoundTripsAndIsTotal) {
  support::Random random(55);
  for (int i = 0; i < 20'000; ++i) {
    auto message = support::any_bytes(random, random.bits() % 121);
    for (std::byte& byte : message) {
      if (random.bits() % 4 == 0) byte = std::byte{0};
    }
    std::array<std::byte, 130> stuffed{};
    const std::size_t size = put_cobs(message, stuffed);
    EXPECT_EQ(std::count(stuffed.begin(), stuffed.begin() + static_cast<std::ptrdiff_t>(size),
                         std::byte{0}),
              1);
    std::vector<std::byte> back(message.size());
    ASSERT_TRUE(take_cobs(std::span(stuffed).first(size), back));
    EXPECT_EQ(back, message);
    (void)take_cobs(support::any_bytes(random, random.bits() % 121), back);
  }
}

TEST(WireTable, DecimalsRoundTrip) {
  support::Random random(56);
  for (int i = 0; i < 10'000; ++i) {
    const double value = static_cast<double>(static_cast<std::int64_t>(random.bits()) >> 34) / 1000;
    std::array<char, 40> text{};
    const char* const end = write_decimal(text.data(), text.data() + text.size(), value, 3);
    double back = 0;
    EXPECT_EQ(read_decimal(text.data(), end, back), end);
    EXPECT_EQ(back, value) << text.data();
  }
  double number = 0;
  for (const std::string bad : {"", "-", ".", "+1", "x", "12345678901", "0.1234567890"}) {
    EXPECT_EQ(read_decimal(bad.data(), bad.data() + bad.size(), number), nullptr) << bad;
  }
}

}  // namespace
}  // namespace thimble::driver
