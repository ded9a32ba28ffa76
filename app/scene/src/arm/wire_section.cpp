#include "arm/wire_section.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "arm/wire_bytes.h"

namespace thimble::scene {
namespace {

using driver::WireCheck;
using driver::WireFraming;
using driver::WireItem;
using driver::WireType;
using driver::WireUnit;

/// Name of a field in arm files.
struct FieldName {
  std::string_view name;
  WireItem item;
  std::uint8_t axis = 0;
};
constexpr FieldName kFieldNames[] = {
    {"encoder_1", WireItem::kEncoder, 0},
    {"encoder_2", WireItem::kEncoder, 1},
    {"encoder_3", WireItem::kEncoder, 2},
    {"gimbal_1", WireItem::kGimbal, 0},
    {"gimbal_2", WireItem::kGimbal, 1},
    {"gimbal_3", WireItem::kGimbal, 2},
    {"buttons", WireItem::kButtons},
    {"sequence", WireItem::kSequence},
    {"time", WireItem::kTime},
    {"errors", WireItem::kErrors},
    {"model", WireItem::kModel},
    {"motor_1", WireItem::kMotor, 0},
    {"motor_2", WireItem::kMotor, 1},
    {"motor_3", WireItem::kMotor, 2},
    {"temperature_1", WireItem::kTemperature, 0},
    {"temperature_2", WireItem::kTemperature, 1},
    {"temperature_3", WireItem::kTemperature, 2},
    {"voltage", WireItem::kVoltage},
    {"constant", WireItem::kConstant},
    {"ignored", WireItem::kIgnored},
};

/// Type in arm files.
struct TypeName {
  std::string_view name;
  WireType type;
  std::size_t bytes;
};
constexpr TypeName kTypeNames[] = {
    {"u8", WireType::kUnsigned, 1},   {"i8", WireType::kSigned, 1},
    {"u16", WireType::kUnsigned, 2},  {"i16", WireType::kSigned, 2},
    {"u32", WireType::kUnsigned, 4},  {"i32", WireType::kSigned, 4},
    {"u64", WireType::kUnsigned, 8},  {"i64", WireType::kSigned, 8},
    {"f32", WireType::kFloat, 4},     {"nibbles", WireType::kNibbles, 4},
    {"number", WireType::kNumber, 0}, {"decimal", WireType::kDecimal, 0},
};

/// Check value in arm files. The parameters of the CRCs are those of the catalogue of Cook (crc8:
/// CRC-8/SMBUS; crc16_ccitt: CRC-16/IBM-3740; crc32: CRC-32/ISO-HDLC).
struct CheckName {
  std::string_view name;
  WireCheck kind;
  std::uint32_t polynomial, initial, final_xor;
  bool reflected;
};
constexpr CheckName kCheckNames[] = {
    {"none", WireCheck::kNone, 0, 0, 0, false},
    {"sum8", WireCheck::kSum8, 0, 0, 0, false},
    {"xor8", WireCheck::kXor8, 0, 0, 0, false},
    {"crc8", WireCheck::kCrc8, 0x07, 0, 0, false},
    {"crc16_ccitt", WireCheck::kCrc16, 0x1021, 0xffff, 0, false},
    {"crc16_xmodem", WireCheck::kCrc16, 0x1021, 0, 0, false},
    {"crc16_modbus", WireCheck::kCrc16, 0x8005, 0xffff, 0, true},
    {"crc32", WireCheck::kCrc32, 0x04c11db7, 0xffffffff, 0xffffffff, true},
};

template <class Row, std::size_t n>
std::vector<std::string_view> names_of(const Row (&rows)[n]) {
  std::vector<std::string_view> names;
  for (const Row& row : rows) names.push_back(row.name);
  return names;
}

/// Reads one section `wire`.
class WireReader {
 public:
  explicit WireReader(YamlMap map) : root_(std::move(map)) {}

  std::shared_ptr<const driver::WireTable> read() {
    driver::WireDescription wire;
    wire.line = {root_.line()};
    wire.transport = static_cast<driver::WireTransport>(
        root_.require_choice("transport", {"hid", "serial", "bulk"}));
    wire.streams = root_.require_choice("exchange", {"ask", "stream"}) == 1;
    wire.watchdog = root_.require_number("watchdog", "s; 0: the board has none", 0, 10);
    big_endian_ = root_.optional_choice("byte_order", 0, {"little", "big"}) == 1;
    wire.baud = static_cast<int>(root_.optional_whole("baud", 115200, "bit/s", 1200, 4'000'000));
    wire.identity = read_identity(root_.require_map("usb"));
    wire.report = read_layout(root_.require_map("report"));
    wire.command = read_layout(root_.require_map("command"));
    if (root_.has("start")) {
      root_.visit_maps("start", [&](YamlMap& step) { wire.start.push_back(read_step(step)); });
    }
    if (root_.has("goodbye")) wire.goodbye = bytes_at(root_, "goodbye", 64);
    root_.finish();
    if (failed_) return nullptr;
    auto compiled = driver::compile_wire(std::move(wire));
    for (const driver::WireMistake& mistake : compiled.mistakes) {
      map_at(mistake.line.number).reject("", mistake.sentence);
    }
    return compiled.table;
  }

 private:
  /// Returns the map at a line, for a message.
  YamlMap& map_at(int line) {
    for (YamlMap& map : maps_) {
      if (map.line() == line) return map;
    }
    return root_;
  }

  void refuse(YamlMap& map, std::string_view key, const std::string& sentence) {
    failed_ = true;
    map.refuse(key, sentence);
  }

  /// Reads bytes as in "aa 55 'text' f32:0.5"; none if the key is absent.
  std::vector<std::byte> bytes_at(YamlMap& map, std::string_view key, std::size_t max) {
    const std::string text = map.optional_string(key, "");
    if (text.empty()) return {};
    const auto bytes = parse_wire_bytes(text, big_endian_);
    if (!bytes) {
      refuse(map, key, bytes.error().message);
      return {};
    }
    if (bytes->bytes.size() > max) {
      refuse(map, key,
             fmt::format("expected at most {} bytes, found {}", max, bytes->bytes.size()));
    }
    for (const bool any : bytes->any) {
      if (any) refuse(map, key, "?? is only for expect; write the byte");
    }
    return bytes->bytes;
  }

  /// Reads a hexadecimal number; 0 if the key is absent.
  std::uint32_t hex_at(YamlMap& map, std::string_view key) {
    const std::string text = map.optional_string(key, "0");
    const auto value = parse_hex(text, 0xffffffff);
    if (!value) refuse(map, key, "expected a hexadecimal number, found \"" + text + '"');
    return value.value_or(0);
  }

  /// Reads two hexadecimal numbers of 16 bits: "16c0:0483".
  std::pair<std::uint16_t, std::uint16_t> pair_at(YamlMap& map, std::string_view key,
                                                  const std::string& text) {
    const std::size_t colon = text.find(':');
    std::optional<std::uint32_t> a, b;
    if (text.empty()) {  // already reported
      failed_ = true;
      return {};
    }
    if (colon != std::string::npos) {
      a = parse_hex(std::string_view(text).substr(0, colon), 0xffff);
      b = parse_hex(std::string_view(text).substr(colon + 1), 0xffff);
    }
    if (!a || !b) {
      refuse(map, key,
             "expected two hexadecimal numbers, as in \"16c0:0483\" (in quotes), found \"" + text +
                 '"');
    }
    return {static_cast<std::uint16_t>(a.value_or(0)), static_cast<std::uint16_t>(b.value_or(0))};
  }

  driver::WireIdentity read_identity(YamlMap map) {
    driver::WireIdentity identity;
    const auto [vendor, product] = pair_at(map, "id", map.require_string("id"));
    identity.vendor_id = vendor;
    identity.product_id = product;
    identity.product = map.optional_string("product", "");
    const std::string usage = map.optional_string("usage", "");
    if (!usage.empty()) {
      std::tie(identity.usage_page, identity.usage) = pair_at(map, "usage", usage);
      if (identity.usage_page < 0xff00) {
        refuse(map, "usage",
               "expected a page of a vendor, from ff00; other pages are those of "
               "keyboards, mice and other devices");
      }
    }
    const auto endpoint = [&](std::string_view key, std::string_view usual) {
      const auto value = parse_hex(map.optional_string(key, usual), 0xff);
      const bool from_board = key == "endpoint_in";
      if (!value || ((*value & 0x80U) != 0) != from_board || (*value & 0x70U) != 0) {
        refuse(map, key,
               std::string("expected a hexadecimal number from ") +
                   (from_board ? "80 to 8f" : "00 to 0f"));
      }
      return static_cast<std::uint8_t>(value.value_or(0));
    };
    identity.endpoint_in = endpoint("endpoint_in", "81");
    identity.endpoint_out = endpoint("endpoint_out", "02");
    map.finish();
    return identity;
  }

  driver::WireStep read_step(YamlMap& map) {
    driver::WireStep step;
    step.line = {map.line()};
    step.send = bytes_at(map, "send", 64);
    const std::string expected = map.optional_string("expect", "");
    if (!expected.empty()) {
      if (auto bytes = parse_wire_bytes(expected, big_endian_)) {
        step.expect = bytes->bytes;
        step.any = bytes->any;
      } else {
        refuse(map, "expect", bytes.error().message);
      }
      if (step.expect.size() > 64) refuse(map, "expect", "expected at most 64 bytes");
    }
    step.within = map.optional_number("within", 0.5, "s", 0.001, 10);
    if (step.send.empty() && step.expect.empty()) {
      refuse(map, "", "expected send, expect, or both");
    }
    map.finish();
    return step;
  }

  driver::WireLayoutText read_layout(YamlMap map) {
    driver::WireLayoutText layout;
    layout.line = {map.line()};
    layout.framing = static_cast<WireFraming>(
        map.require_choice("framing", {"fixed", "header", "text", "cobs", "slip", "length"}));
    constexpr auto kMark = driver::kWireMarkMax;
    layout.size = static_cast<std::size_t>(
        map.optional_whole("size", 0, "bytes", 0, std::int64_t{driver::kWireSizeMax}));
    layout.padded = static_cast<std::size_t>(
        map.optional_whole("padded", 0, "bytes", 0, std::int64_t{driver::kReportCapacity}));
    layout.begin = bytes_at(map, "begin", kMark);
    layout.end = bytes_at(map, "end", kMark);
    layout.separator = bytes_at(map, "separator", kMark);
    layout.ignore = bytes_at(map, "ignore", kMark);
    read_length(map, layout);
    read_check(map, layout);
    map.visit_maps("fields", [&](YamlMap& field) {
      layout.fields.push_back(read_field(field));
      maps_.push_back(field);
    });
    map.finish();
    maps_.push_back(map);
    return layout;
  }

  void read_length(YamlMap& map, driver::WireLayoutText& layout) {
    constexpr std::int64_t kMax{driver::kWireSizeMax};
    const bool measured = layout.framing == WireFraming::kLength;
    layout.length_at =
        map.has("length_at")
            ? static_cast<std::size_t>(map.require_whole("length_at", "bytes", 0, kMax))
        : measured ? layout.begin.size()
                   : 0;
    layout.length_adds =
        static_cast<std::size_t>(map.optional_whole("length_adds", 0, "bytes", 0, kMax));
  }

  void read_check(YamlMap& map, driver::WireLayoutText& layout) {
    const CheckName& name = kCheckNames[map.optional_choice("checksum", 0, names_of(kCheckNames))];
    driver::WireCheckText& check = layout.check;
    check = {.kind = name.kind,
             .polynomial = name.polynomial,
             .initial = name.initial,
             .final_xor = name.final_xor,
             .reflected = name.reflected};
    const std::size_t tail = check.bytes() + layout.end.size();
    const std::size_t usual = layout.size > tail ? layout.size - tail : 0;
    check.from = static_cast<std::size_t>(
        map.optional_whole("checksum_from", 0, "bytes", 0, std::int64_t{driver::kWireSizeMax}));
    check.at = map.has("checksum_at")
                   ? static_cast<std::size_t>(map.require_whole("checksum_at", "bytes", 0,
                                                                std::int64_t{driver::kWireSizeMax}))
                   : usual;
    const std::size_t order = map.optional_choice("checksum_order", 2, {"little", "big", "wire"});
    check.big_endian = order == 2 ? big_endian_ : order == 1;
    if (map.has("crc")) {
      YamlMap crc = map.require_map("crc");
      check.polynomial = hex_at(crc, "polynomial");
      check.initial = hex_at(crc, "initial");
      check.final_xor = hex_at(crc, "final");
      check.reflected = crc.optional_bool("reflected", false);
      if (name.kind < WireCheck::kCrc8)
        refuse(crc, "", "needs a checksum whose name begins with crc");
      crc.finish();
    }
  }

  driver::WireFieldText read_field(YamlMap& map) {
    driver::WireFieldText field;
    field.line = {map.line()};
    const FieldName& name = kFieldNames[map.require_choice("name", names_of(kFieldNames))];
    field.name = std::string(name.name);
    field.item = name.item;
    field.axis = name.axis;
    const TypeName& type = kTypeNames[map.require_choice("type", names_of(kTypeNames))];
    field.type = type.type;
    field.bytes = type.bytes;
    if (type.type == WireType::kNibbles) {
      field.bytes = static_cast<std::size_t>(map.optional_whole("count", 4, "nibbles", 1, 8));
    }
    if (type.bytes > 0) {
      field.at = static_cast<std::size_t>(
          map.optional_whole("at", 0, "bytes", 0, std::int64_t{driver::kWireSizeMax}));
      if (!map.has("at")) refuse(map, "", "needs at, the first byte of " + field.name);
      const std::size_t order = map.optional_choice("byte_order", 2, {"little", "big", "wire"});
      field.big_endian = order == 2 ? big_endian_ : order == 1;
      read_bits(map, field);
      field.inverted = map.optional_bool("inverted", false);
      field.minus = static_cast<int>(map.optional_whole("minus", 0, "", 0, 255));
    }
    field.scale = map.optional_number("scale", 1, "", -1e9, 1e9);
    field.offset = map.optional_number("offset", 0, "", -1e12, 1e12);
    if (field.item == WireItem::kConstant) {
      field.value = map.optional_whole("value", 0, "", -(std::int64_t{1} << 31), 0xffffffff);
      if (!map.has("value")) refuse(map, "", "a constant needs value");
    }
    if (field.item == WireItem::kErrors) read_flags(map, field);
    if (field.item == WireItem::kEncoder) {
      field.wrap = static_cast<int>(map.optional_whole("wrap", 0, "bits", 0, 31));
    }
    if (field.item == WireItem::kMotor) read_motor(map, field, type);
    map.finish();
    return field;
  }

  void read_bits(YamlMap& map, driver::WireFieldText& field) {
    if (!map.has("bit") && !map.has("bits")) return;
    field.bit_first = static_cast<int>(map.optional_whole("bit", 0, "", 0, 63));
    const auto count = static_cast<int>(map.optional_whole("bits", 1, "", 1, 64));
    field.bit_last = field.bit_first + count - 1;
  }

  void read_flags(YamlMap& map, driver::WireFieldText& field) {
    field.bit_names = words(map.optional_string("flags", ""));
    for (const std::string& name : words(map.optional_string("reject", ""))) {
      const auto found = std::find(field.bit_names.begin(), field.bit_names.end(), name);
      if (name == "any") {
        field.reject = 0xffffffff;
      } else if (found == field.bit_names.end() || name == "-") {
        refuse(map, "reject", "expected any, or names of flags, found \"" + name + '"');
      } else {
        field.reject |= 1U << static_cast<unsigned>(found - field.bit_names.begin());
      }
    }
    if (field.bit_names.size() > 32) refuse(map, "flags", "expected at most 32 names");
  }

  void read_motor(YamlMap& map, driver::WireFieldText& field, const TypeName& type) {
    field.unit =
        static_cast<WireUnit>(map.optional_choice("unit", 0, {"A", "N m", "duty", "duty_root"}));
    if (!map.has("unit")) refuse(map, "", "a motor needs unit: A, N m, duty or duty_root");
    field.full = map.optional_number("full", 0, "N m", 0, 100);
    field.limit = map.optional_number("limit", 0, "", 0, 1e9);
    if (type.type == WireType::kDecimal) {
      field.decimals = static_cast<int>(map.optional_whole("decimals", 3, "digits", 0, 9));
    }
  }

  /// Splits words at commas.
  static std::vector<std::string> words(const std::string& text) {
    std::vector<std::string> list;
    std::string word;
    for (const char c : text + ",") {
      if (c == ',') {
        if (!word.empty()) list.push_back(word);
        word.clear();
      } else if (c != ' ') {
        word += c;
      }
    }
    return list;
  }

  YamlMap root_;
  std::vector<YamlMap> maps_;
  bool big_endian_ = false;
  bool failed_ = false;
};

}  // namespace

std::shared_ptr<const driver::WireTable> read_wire(YamlMap map) {
  return WireReader(std::move(map)).read();
}

driver::Result<std::shared_ptr<const driver::WireTable>> load_wire(
    const std::filesystem::path& file) {
  driver::Result<YamlFile> yaml = YamlFile::load(file);
  if (!yaml) return yaml.error();
  auto wire = read_wire(yaml->root().require_map("wire"));
  if (auto done = yaml->finish(); !done) return done.error();
  if (!wire) return driver::Error{file.string() + ": the section wire could not be read."};
  return wire;
}

std::string wire_field_name(driver::WireItem item, std::size_t axis) {
  for (const FieldName& row : kFieldNames) {
    if (row.item == item && row.axis == axis) return std::string(row.name);
  }
  return "field";
}

}  // namespace thimble::scene
