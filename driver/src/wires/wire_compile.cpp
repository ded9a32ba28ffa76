#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "wires/slip.h"
#include "wires/wire_table.h"

namespace thimble::driver {
namespace {

bool is_text_type(WireType type) noexcept {
  return type == WireType::kNumber || type == WireType::kDecimal;
}

std::string bytes_in_words(std::size_t first, std::size_t count) {
  const std::string begin = std::to_string(first);
  return count == 1 ? "byte " + begin
                    : "bytes " + begin + " to " + std::to_string(first + count - 1);
}

/// Compiles one direction.
class LayoutCompiler {
 public:
  LayoutCompiler(const WireLayoutText& text, std::string name, std::vector<WireMistake>& mistakes)
      : text_(text), name_(std::move(name)), mistakes_(mistakes) {}

  WireLayout compile() {
    WireLayout layout;
    layout.framing = text_.framing;
    layout.begin = mark(text_.begin, "begin");
    layout.end = mark(text_.end, "end");
    layout.separator = mark(text_.separator, "separator");
    layout.ignore = mark(text_.ignore, "ignore");
    layout.size = text_.size;
    layout.padded = text_.padded == 0 ? text_.size : text_.padded;
    layout.length_at = text_.length_at;
    layout.length_adds = text_.length_adds;
    check_frame(layout);
    if (layout.ignore.size > 0) check_ignore(layout);
    set_check(layout);
    if (text_.fields.empty()) mistake(text_.line, "expected at least one field");
    if (text_.fields.size() > kWireFieldsMax) {
      mistake(text_.line, "expected at most " + std::to_string(kWireFieldsMax) + " fields");
      return layout;
    }
    for (const WireFieldText& field : text_.fields) {
      layout.ops[layout.op_count++] = op_of(field, layout);
    }
    check_overlaps(layout);
    check_twice();
    if (mistakes_.empty()) make_blank(layout);
    return layout;
  }

 private:
  void mistake(WireLine line, const std::string& sentence) {
    mistakes_.push_back({line, name_ + ": " + sentence});
  }
  void mistake(const WireFieldText& field, const std::string& sentence) {
    mistakes_.push_back({field.line, name_ + ": field " + field.name + ": " + sentence});
  }

  WireMark mark(const std::vector<std::byte>& bytes, const char* key) {
    WireMark mark;
    if (bytes.size() > kWireMarkMax) {
      mistake(text_.line, std::string(key) + ": expected at most " + std::to_string(kWireMarkMax) +
                              " bytes, found " + std::to_string(bytes.size()));
      return mark;
    }
    std::copy(bytes.begin(), bytes.end(), mark.bytes.begin());
    mark.size = static_cast<std::uint8_t>(bytes.size());
    return mark;
  }

  void check_frame(WireLayout& layout) {
    if (layout.framing == WireFraming::kText) {
      if (layout.end.size == 0) mistake(text_.line, "end: a text needs its last byte, as \"0a\"");
      if (layout.size == 0) layout.size = kReportCapacity;
      if (text_.check.kind != WireCheck::kNone) {
        mistake(text_.line, "checksum: cannot be used with framing: text");
      }
      return;
    }
    if (text_.size == 0 || text_.size > kWireSizeMax) {
      mistake(text_.line, "size: expected from 1 to " + std::to_string(kWireSizeMax) +
                              " bytes, found " + std::to_string(text_.size));
      return;
    }
    if (layout.framing == WireFraming::kHeader && layout.begin.size == 0) {
      mistake(text_.line, "begin: framing: header needs the first bytes of a message");
    }
    if (layout.padded < text_.size || layout.padded > kReportCapacity) {
      mistake(text_.line, "padded: expected from size, " + std::to_string(text_.size) + ", to " +
                              std::to_string(kReportCapacity) + " bytes");
    }
    if (std::size_t{layout.begin.size} + layout.end.size > text_.size) {
      mistake(text_.line, "size: begin and end need " +
                              std::to_string(layout.begin.size + layout.end.size) +
                              " bytes, but the message has " + std::to_string(text_.size));
    }
    if (layout.framing == WireFraming::kSlip && text_.size > kWireSlipSizeMax) {
      mistake(text_.line, "size: expected at most " + std::to_string(kWireSlipSizeMax) +
                              " bytes with framing: slip, found " + std::to_string(text_.size));
    }
    if (layout.framing == WireFraming::kLength) {
      check_length(layout);
    } else if (text_.length_at != 0 || text_.length_adds != 0) {
      mistake(text_.line, "length_at and length_adds need framing: length; remove them");
    }
  }

  /// Checks the byte with the length, and that the shortest message has room for the parts whose
  /// places do not depend on it.
  void check_length(const WireLayout& layout) {
    const std::string place = "length_at: " + bytes_in_words(text_.length_at, 1);
    if (layout.begin.size == 0) {
      mistake(text_.line, "begin: framing: length needs the first bytes of a message");
    }
    if (text_.length_at < layout.begin.size) mistake(text_.line, place + " overlaps begin");
    const std::size_t tail = text_.check.bytes() + layout.end.size;
    if (text_.length_at + 1 + tail > text_.size) {
      mistake(text_.line, place + " is not before the checksum and the end of a message of " +
                              std::to_string(text_.size) + " bytes");
    }
    constexpr std::size_t kByteMax = 255;
    if (text_.length_adds > text_.size || text_.size - text_.length_adds > kByteMax) {
      mistake(text_.line, "length_adds: expected at most size, " + std::to_string(text_.size) +
                              " bytes, found " + std::to_string(text_.length_adds));
    }
    if (text_.check.kind != WireCheck::kNone && text_.check.at + tail != text_.size) {
      mistake(text_.line,
              "checksum_at: cannot be used with framing: length, because the place of the check "
              "value depends on the length; remove it");
    }
  }

  void check_ignore(const WireLayout& layout) {
    const bool cobs = layout.framing == WireFraming::kCobs;
    const bool slip = layout.framing == WireFraming::kSlip;
    if (layout.framing == WireFraming::kFixed || layout.framing == WireFraming::kHeader) {
      mistake(text_.line, "ignore: needs framing: text, cobs, slip or length");
    }
    const auto bytes = layout.ignore.span();
    const auto has = [&](std::byte byte) {
      return std::find(bytes.begin(), bytes.end(), byte) != bytes.end();
    };
    if (cobs && has(std::byte{0})) {
      mistake(text_.line, "ignore: must not contain 00 with framing: cobs");
    }
    if (slip && (has(kSlipEnd) || has(kSlipEscape))) {
      mistake(text_.line, "ignore: must not contain c0 or db with framing: slip");
    }
  }

  void set_check(WireLayout& layout) {
    const WireCheckText& check = text_.check;
    layout.check_bytes = check.bytes();
    if (layout.check_bytes == 0) return;
    layout.check_at = check.at;
    layout.check_from = check.from;
    layout.check_big_endian = check.big_endian;
    if (check.at + check.bytes() > text_.size) {
      mistake(text_.line, "checksum: its " + bytes_in_words(check.at, check.bytes()) +
                              " end beyond the message of " + std::to_string(text_.size) +
                              " bytes");
    }
    if (check.at < layout.begin.size) {
      mistake(text_.line,
              "checksum: its " + bytes_in_words(check.at, check.bytes()) + " overlap begin");
    }
    if (layout.end.size > 0 && check.at + check.bytes() + layout.end.size > text_.size &&
        check.at + check.bytes() <= text_.size) {
      mistake(text_.line,
              "checksum: its " + bytes_in_words(check.at, check.bytes()) + " overlap end");
    }
    if (check.from >= check.at) {
      mistake(text_.line, "checksum: covers no byte, because checksum_from " +
                              std::to_string(check.from) + " is not before its byte " +
                              std::to_string(check.at));
    }
    layout.checksum = WireChecksum(check);
  }

  WireOp op_of(const WireFieldText& field, const WireLayout& layout) {
    WireOp op;
    const bool text = layout.framing == WireFraming::kText;
    op.item = field.item;
    op.type = field.type;
    op.axis = static_cast<std::uint8_t>(field.axis);
    op.decimals = static_cast<std::uint8_t>(std::clamp(field.decimals, 0, 9));
    op.big_endian = field.big_endian;
    op.scale = field.scale;
    op.offset = field.offset;
    op.value = field.value;
    op.reject = field.reject;
    op.unit = field.unit;
    op.full = field.full;
    if (text != is_text_type(field.type)) {
      mistake(field, text ? "expected type number or decimal in a text"
                          : "number and decimal need framing: text");
      return op;
    }
    if (!(std::isfinite(field.scale) && field.scale != 0 && std::isfinite(field.offset))) {
      mistake(field, "scale: expected a finite number other than zero");
      return op;
    }
    op.to_raw = 1 / field.scale;
    op.exact = field.scale == 1 && field.offset == 0 && field.type != WireType::kFloat &&
               field.type != WireType::kDecimal;
    if (field.item == WireItem::kMotor) check_motor(field, op);
    const bool real = field.type == WireType::kFloat || field.type == WireType::kDecimal;
    if (real && needs_integer(field.item)) {
      mistake(field, "type: expected an integer, because its bits or exact value count");
    }
    if (text) {
      const double top = field.type == WireType::kNumber ? 2147483647.0 : 1e9;
      op.raw_min = -top;
      op.raw_max = top;
    } else {
      place(field, layout, op);
    }
    if (field.wrap != 0) set_wrap(field, op);
    // A limit is one of the value, whose zero may be another raw value.
    const double zero = -op.offset * op.to_raw;
    if (field.limit > 0) {
      const double limit = std::abs(field.limit * op.to_raw);
      op.raw_max = std::min(op.raw_max, zero + limit);
      op.raw_min = std::max(op.raw_min, zero - limit);
    }
    if (field.item == WireItem::kMotor) check_zero(field, op, zero);
    constexpr int kSequenceBits = 4;  // [chosen: 20 reports in a row are then no chance]
    if (field.item == WireItem::kSequence && op.bit_count < kSequenceBits) {
      mistake(field, "bits: a sequence number needs at least 4 bits");
    }
    return op;
  }

  static bool needs_integer(WireItem item) noexcept {
    return item == WireItem::kButtons || item == WireItem::kSequence || item == WireItem::kTime ||
           item == WireItem::kConstant || item == WireItem::kErrors || item == WireItem::kModel;
  }

  /// Reads a counter as its lowest bits in two's complement, so that values below zero are not far
  /// above it.
  void set_wrap(const WireFieldText& field, WireOp& op) {
    constexpr int kBitsMin = 8, kBitsMax = 31;  // [chosen: more bits do not wrap within an arm]
    if (field.item != WireItem::kEncoder) mistake(field, "wrap: needs an encoder");
    if (!op.exact) mistake(field, "wrap: needs an integer type, scale 1 and offset 0");
    if (field.wrap < kBitsMin || field.wrap > kBitsMax) {
      mistake(field, "wrap: expected from 8 to 31 bits, found " + std::to_string(field.wrap));
      return;
    }
    op.wrap = static_cast<std::uint8_t>(field.wrap);
    if (field.type == WireType::kNumber) return;
    if (field.wrap > op.bit_count) {
      mistake(field, "wrap: " + bytes_in_words(field.at, field.bytes) + " have " +
                         std::to_string(op.bit_count) + " bits for the counter, fewer than " +
                         std::to_string(field.wrap));
      return;
    }
    if (op.type == WireType::kUnsigned) op.type = WireType::kSigned;
    op.bit_count = op.wrap;
  }

  void check_motor(const WireFieldText& field, WireOp& op) {
    op.exact = false;
    const bool duty = field.unit == WireUnit::kDuty || field.unit == WireUnit::kDutyRoot;
    if (duty && !(field.full > 0 && std::isfinite(field.full))) {
      mistake(field, "full: a duty cycle needs the torque at full duty cycle, N m");
    }
    if (!duty && field.full != 0) mistake(field, "full: needs unit duty or duty_root");
  }

  /// A motor must be able to get exactly zero, and values on both sides of it in fine steps: a
  /// rounded current is never far above the one that was requested.
  void check_zero(const WireFieldText& field, const WireOp& op, double zero) {
    constexpr double kStepsMin = 20;  // on each side of zero [chosen: rounding adds 2.5 % at most]
    if (op.type == WireType::kFloat || op.type == WireType::kDecimal) {
      if (op.offset != 0) mistake(field, "offset: a motor value with a fraction has none");
      return;
    }
    if (!(op.raw_max > op.raw_min)) return;  // its place was refused
    constexpr double kRounding = 1e-9;
    if (!(std::abs(zero - std::round(zero)) <= kRounding * std::max(1.0, std::abs(zero)))) {
      mistake(field,
              "offset: zero would not be a whole raw value, so the motor would never be off");
    } else if (!(zero - op.raw_min >= kStepsMin && op.raw_max - zero >= kStepsMin)) {
      const bool placed = op.type != WireType::kNumber;
      mistake(field, (placed ? bytes_in_words(field.at, field.bytes) + ": " : std::string()) +
                         "zero is the raw value " + std::to_string(zero) + ", and " +
                         std::to_string(op.raw_min) + " to " + std::to_string(op.raw_max) +
                         " can be sent; expected at least 20 steps on both sides of zero, so an "
                         "unsigned value needs an offset");
    }
  }

  void place(const WireFieldText& field, const WireLayout& layout, WireOp& op) {
    op.at = static_cast<std::uint8_t>(std::min<std::size_t>(field.at, 255));
    op.bytes = static_cast<std::uint8_t>(field.bytes);
    const bool nibbles = field.type == WireType::kNibbles;
    const bool sizes =
        nibbles ? field.bytes >= 1 && field.bytes <= 8
                : field.bytes == 1 || field.bytes == 2 || field.bytes == 4 || field.bytes == 8;
    if (!sizes || (field.type == WireType::kFloat && field.bytes != 4)) {
      mistake(field, "type: has a length of " + std::to_string(field.bytes) +
                         " bytes, which its kind does not have");
      return;
    }
    if (field.at + field.bytes > layout.size) {
      mistake(field, bytes_in_words(field.at, field.bytes) + " end beyond the message of " +
                         std::to_string(layout.size) + " bytes");
      return;
    }
    const auto bits = static_cast<int>((nibbles ? 4 : 8) * field.bytes);
    const int first = field.bit_first < 0 ? 0 : field.bit_first;
    const int last = field.bit_last < 0 ? bits - 1 : field.bit_last;
    if (first > last || last >= bits) {
      mistake(field, "bits: expected a range within 0 to " + std::to_string(bits - 1) + ", found " +
                         std::to_string(first) + " to " + std::to_string(last));
      return;
    }
    op.bit_first = static_cast<std::uint8_t>(first);
    op.bit_count = static_cast<std::uint8_t>(last - first + 1);
    const bool ranged = op.bit_count != bits;
    if (field.type == WireType::kFloat && (ranged || field.inverted || field.minus != 0)) {
      mistake(field, "bits, inverted and minus cannot be used with a float");
    }
    if (field.inverted) op.flip = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    op.minus = static_cast<std::uint64_t>(field.minus);
    constexpr int kDigitMax = 255 - 15;  // so that the largest nibble fits its byte
    if (nibbles && field.minus > kDigitMax) {
      mistake(field,
              "minus: expected at most 240 with nibbles, found " + std::to_string(field.minus));
    }
    if (field.minus != 0 && !nibbles && field.bytes != 1) {
      mistake(field, "minus: needs one byte, or nibbles");
    }
    const bool is_signed = field.type == WireType::kSigned || nibbles;
    if (field.type == WireType::kFloat) {
      op.raw_max = std::numeric_limits<float>::max();
      op.raw_min = -op.raw_max;
    } else if (is_signed) {
      op.raw_max = std::ldexp(1.0, op.bit_count - 1) - 1;
      op.raw_min = -op.raw_max;
    } else {
      op.raw_max = std::ldexp(1.0, op.bit_count) - 1;
      op.raw_min = 0;
    }
    if (field.item == WireItem::kConstant) {
      const auto value = static_cast<double>(field.value);
      const double min = is_signed ? -std::ldexp(1.0, op.bit_count - 1) : 0;
      if (value < min || value > op.raw_max) {
        mistake(field, "value: " + std::to_string(field.value) + " does not fit " +
                           bytes_in_words(field.at, field.bytes));
      }
    }
  }

  /// Two fields may share bytes if they read them. In a command, only constants and different bits
  /// may.
  void check_overlaps(WireLayout& layout) {
    if (layout.framing == WireFraming::kText) return;
    const auto taken_by_frame = [&](std::size_t at, std::size_t bytes) -> const char* {
      if (at < layout.begin.size) return "begin";
      if (layout.framing == WireFraming::kLength && at <= layout.length_at &&
          layout.length_at < at + bytes) {
        return "the byte with the length";
      }
      if (layout.end.size > 0 && at + bytes > layout.size - layout.end.size) return "end";
      if (layout.check_bytes > 0 && at < layout.check_at + layout.check_bytes &&
          layout.check_at < at + bytes) {
        return "the checksum";
      }
      return nullptr;
    };
    for (std::size_t i = 0; i < layout.op_count; ++i) {
      WireOp& a = layout.ops[i];
      const WireFieldText& field = text_.fields[i];
      if (const char* part = taken_by_frame(a.at, a.bytes)) {
        mistake(field, bytes_in_words(a.at, a.bytes) + " overlap " + part);
      }
      for (std::size_t k = 0; k < i; ++k) {
        WireOp& b = layout.ops[k];
        const bool bytes = a.at < b.at + b.bytes && b.at < a.at + a.bytes;
        const bool same_bytes = a.at == b.at && a.bytes == b.bytes && a.type == b.type;
        const bool bits =
            a.bit_first < b.bit_first + b.bit_count && b.bit_first < a.bit_first + a.bit_count;
        if (!bytes || (same_bytes && !bits)) continue;
        const bool shown_only = same_bytes && (shares(a.item) || shares(b.item));
        if (shown_only) {
          (shares(a.item) ? a : b).shown_only = true;
          continue;
        }
        mistake(field, bytes_in_words(a.at, a.bytes) + " overlap field " + text_.fields[k].name +
                           " (" + bytes_in_words(b.at, b.bytes) + ")");
      }
    }
  }

  /// Items that may also show the bits of another field.
  static bool shares(WireItem item) noexcept {
    return item == WireItem::kGimbal || item == WireItem::kIgnored;
  }

  void check_twice() {
    const auto once = [](WireItem item) {
      return item != WireItem::kConstant && item != WireItem::kIgnored;
    };
    for (std::size_t i = 0; i < text_.fields.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const WireFieldText &a = text_.fields[i], &b = text_.fields[k];
        if (once(a.item) && a.item == b.item && a.axis == b.axis) {
          mistake(a, "is described twice; remove one");
        }
      }
    }
  }

  void make_blank(WireLayout& layout) {
    if (layout.framing == WireFraming::kText) return;
    std::copy_n(layout.begin.bytes.begin(), layout.begin.size, layout.blank.begin());
    if (layout.framing == WireFraming::kLength) {
      layout.blank[layout.length_at] = static_cast<std::byte>(layout.size - layout.length_adds);
    }
    for (std::size_t i = 0; i < layout.op_count; ++i) {
      const WireOp& op = layout.ops[i];
      std::fill_n(layout.blank.begin() + op.at, op.bytes, static_cast<std::byte>(op.minus));
    }
    std::copy_n(layout.end.bytes.begin(), layout.end.size,
                layout.blank.begin() + static_cast<std::ptrdiff_t>(layout.size - layout.end.size));
  }

  const WireLayoutText& text_;
  std::string name_;
  std::vector<WireMistake>& mistakes_;
};

void check_items(const WireLayoutText& layout, const char* name, bool motors,
                 std::vector<WireMistake>& mistakes) {
  const WireItem wanted = motors ? WireItem::kMotor : WireItem::kEncoder;
  const char* const word = motors ? "motor" : "encoder";
  std::array<bool, 3> axes{};
  for (const WireFieldText& field : layout.fields) {
    if (field.item == wanted) axes[field.axis] = true;
    if (field.item == (motors ? WireItem::kEncoder : WireItem::kMotor)) {
      mistakes.push_back({field.line, std::string(name) + ": field " + field.name +
                                          ": belongs into " + (motors ? "report" : "command")});
    }
  }
  if (!axes[0] || (axes[2] && !axes[1])) {
    mistakes.push_back({layout.line, std::string(name) + ": expected " + word + "_1, and also " +
                                         word + "_2 and " + word + "_3 for further axes"});
  }
}

}  // namespace

WireCompiled compile_wire(WireDescription description) {
  WireCompiled result;
  auto table = std::make_shared<WireTable>();
  table->report = LayoutCompiler(description.report, "report", result.mistakes).compile();
  table->command = LayoutCompiler(description.command, "command", result.mistakes).compile();
  check_items(description.report, "report", false, result.mistakes);
  check_items(description.command, "command", true, result.mistakes);
  if (result.mistakes.empty()) {
    std::size_t encoders = 0, motors = 0;
    for (const WireFieldText& f : description.report.fields)
      encoders += f.item == WireItem::kEncoder;
    for (const WireFieldText& f : description.command.fields) motors += f.item == WireItem::kMotor;
    if (encoders != motors) {
      result.mistakes.push_back({description.line, "expected as many encoders as motors, found " +
                                                       std::to_string(encoders) + " and " +
                                                       std::to_string(motors)});
    }
  }
  const bool hid = description.transport == WireTransport::kHid;
  // A HID report is one message of a fixed length.
  constexpr std::pair<WireFraming, const char*> kStreamed[] = {
      {WireFraming::kCobs, "cobs"}, {WireFraming::kSlip, "slip"}, {WireFraming::kLength, "length"}};
  for (const auto& [framing, name] : kStreamed) {
    for (const WireLayoutText* layout : {&description.report, &description.command}) {
      if (!hid || layout->framing != framing) continue;
      result.mistakes.push_back(
          {layout->line, std::string("framing: ") + name + " needs transport: serial"});
    }
  }
  if (!hid && description.streams && description.report.framing == WireFraming::kFixed) {
    result.mistakes.push_back(
        {description.report.line,
         "report: framing: fixed has no marks, so it needs transport: hid or exchange: ask"});
  }
  if (!hid && (description.report.padded > description.report.size ||
               description.command.padded > description.command.size)) {
    result.mistakes.push_back({description.report.line, "padded: needs transport: hid"});
  }
  if (!result.mistakes.empty()) return result;
  table->numbered = table->report.has(WireItem::kSequence);
  table->timed = !table->numbered && table->report.has(WireItem::kTime);
  for (std::size_t i = 0; i < table->report.op_count; ++i) {
    const WireOp& op = table->report.ops[i];
    if (op.wrap == 0) continue;
    table->wraps = true;
    table->wrap[op.axis] = op.wrap;
  }
  table->text = std::move(description);
  result.table = std::move(table);
  return result;
}

}  // namespace thimble::driver
