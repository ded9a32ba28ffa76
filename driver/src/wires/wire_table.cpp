#include "wires/wire_table.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "thimble/driver/wire_arm.h"
#include "wires/cobs.h"
#include "wires/decimal_text.h"
#include "wires/slip.h"

namespace thimble::driver {
namespace {

constexpr WireVerdict verdict(WireFlaw flaw, std::size_t byte = 0, std::size_t field = 0) noexcept {
  return {flaw, static_cast<std::uint8_t>(byte), static_cast<std::uint8_t>(field)};
}

// memcpy with a constant size is one load or store.
template <class Word>
std::uint64_t load(const std::byte* at) noexcept {
  Word word;
  std::memcpy(&word, at, sizeof(word));
  return word;
}
template <class Word>
void store(std::byte* at, std::uint64_t value) noexcept {
  const auto word = static_cast<Word>(value);
  std::memcpy(at, &word, sizeof(word));
}

std::uint64_t load_bytes(const std::byte* at, unsigned bytes, bool big_endian) noexcept {
  std::uint64_t value = 0;
  switch (bytes) {
    case 1:
      return load<std::uint8_t>(at);
    case 2:
      value = load<std::uint16_t>(at);
      break;
    case 4:
      value = load<std::uint32_t>(at);
      break;
    default:
      value = load<std::uint64_t>(at);
      break;
  }
  return big_endian ? __builtin_bswap64(value) >> (64 - 8 * bytes) : value;
}

void store_bytes(std::byte* at, unsigned bytes, bool big_endian, std::uint64_t value) noexcept {
  if (big_endian && bytes > 1) value = __builtin_bswap64(value) >> (64 - 8 * bytes);
  switch (bytes) {
    case 1:
      return store<std::uint8_t>(at, value);
    case 2:
      return store<std::uint16_t>(at, value);
    case 4:
      return store<std::uint32_t>(at, value);
    default:
      return store<std::uint64_t>(at, value);
  }
}

constexpr std::uint64_t low_bits(unsigned count) noexcept {
  return count >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

/// Returns the lowest bits of a value as an integer in two's complement.
constexpr std::int64_t sign_extended(std::uint64_t bits, unsigned count) noexcept {
  const unsigned shift = 64U - count;
  return static_cast<std::int64_t>(bits << shift) >> shift;
}

/// A raw value: an integer, or a real number.
struct Raw {
  std::int64_t whole = 0;
  double real = 0;
};

/// Reads the raw value of a field that is not text; false if the bytes are no such value.
inline bool read_raw(const WireOp& op, const std::byte* body, Raw& raw) noexcept {
  const std::byte* const at = body + op.at;
  std::uint64_t bits = 0;
  unsigned width = 8U * op.bytes;
  if (op.type == WireType::kNibbles) {
    width = 4U * op.bytes;
    for (unsigned k = 0; k < op.bytes; ++k) {
      // Below the first digit the difference wraps around and is far above 15.
      const std::uint64_t nibble = load<std::uint8_t>(at + k) - op.minus;
      if (nibble > 15) return false;
      bits |= nibble << (4 * k);
    }
  } else {
    bits = load_bytes(at, op.bytes, op.big_endian);
    if (op.type == WireType::kFloat) {
      raw.real = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
      return std::isfinite(raw.real);
    }
    bits -= op.minus;
  }
  bits ^= op.flip;
  if (op.bit_count != width) {
    bits = (bits >> op.bit_first) & low_bits(op.bit_count);
  }
  if (op.type == WireType::kUnsigned) {
    raw.whole = static_cast<std::int64_t>(bits & low_bits(op.bit_count));
  } else {
    raw.whole = sign_extended(bits, op.bit_count);
  }
  if (!op.exact) raw.real = static_cast<double>(raw.whole);
  return true;
}

/// Writes a raw value into a message whose bits are zero there.
inline void write_raw(const WireOp& op, std::byte* body, const Raw& raw) noexcept {
  std::byte* const at = body + op.at;
  if (op.type == WireType::kFloat) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(raw.real));
    return store_bytes(at, 4, op.big_endian, bits);
  }
  std::uint64_t bits = static_cast<std::uint64_t>(raw.whole) & low_bits(op.bit_count);
  if (op.type == WireType::kNibbles) {
    bits = (bits << op.bit_first) ^ op.flip;
    for (unsigned k = 0; k < op.bytes; ++k) {
      store<std::uint8_t>(at + k, ((bits >> (4 * k)) & 15U) + op.minus);
    }
    return;
  }
  const unsigned width = 8U * op.bytes;
  if (op.bit_count != width) {
    // Other fields may have written their bits of the same bytes.
    const std::uint64_t mask = low_bits(op.bit_count) << op.bit_first;
    const std::uint64_t before = load_bytes(at, op.bytes, op.big_endian) - op.minus;
    bits = (before & ~mask) | (((bits << op.bit_first) ^ op.flip) & mask);
  } else {
    bits ^= op.flip;
  }
  store_bytes(at, op.bytes, op.big_endian, bits + op.minus);
}

double saturated(double value, double bound) noexcept {
  return std::min(std::max(value, -bound), bound);
}

/// Rounds a real number to a count, halves away from zero.
std::int32_t count_of(double value) noexcept {
  return round_half_away(saturated(value, 2147483647.0));
}

/// Converts a motor value into amperes.
double amperes_of(const WireOp& op, double value) noexcept {
  switch (op.unit) {
    case WireUnit::kAmpere:
      return value;
    case WireUnit::kNewtonMetre:
    case WireUnit::kDuty:
      return value / op.gain;
    case WireUnit::kDutyRoot:
      return std::copysign(value * value, value) / op.gain;
  }
  return 0;
}

/// Converts amperes into a motor value.
double motor_value(const WireOp& op, double amperes) noexcept {
  switch (op.unit) {
    case WireUnit::kAmpere:
      return amperes;
    case WireUnit::kNewtonMetre:
      return amperes * op.gain;
    case WireUnit::kDuty:
      return saturated(amperes * op.gain, 1);
    case WireUnit::kDutyRoot:
      return std::copysign(std::min(std::sqrt(std::abs(amperes * op.gain)), 1.0), amperes);
  }
  return 0;
}

/// Puts a raw value into the values; a flaw if it is not allowed.
inline WireFlaw take(const WireOp& op, const Raw& raw, WireValues& values) noexcept {
  switch (op.item) {
    case WireItem::kEncoder:
      values.encoders[op.axis] = op.exact ? static_cast<std::int32_t>(raw.whole)
                                          : count_of(raw.real * op.scale + op.offset);
      return WireFlaw::kNone;
    case WireItem::kGimbal:
      values.gimbal[op.axis] = op.exact ? static_cast<std::int32_t>(raw.whole)
                                        : count_of(raw.real * op.scale + op.offset);
      return WireFlaw::kNone;
    case WireItem::kButtons:
      values.buttons = static_cast<std::uint32_t>(raw.whole);
      return WireFlaw::kNone;
    case WireItem::kSequence:
      values.sequence = raw.whole;
      return WireFlaw::kNone;
    case WireItem::kTime:
      values.time = raw.whole;
      return WireFlaw::kNone;
    case WireItem::kMotor:
      values.motors[op.axis] =
          amperes_of(op, (op.type == WireType::kFloat || op.type == WireType::kDecimal
                              ? raw.real
                              : static_cast<double>(raw.whole)) *
                                 op.scale +
                             op.offset);
      return WireFlaw::kNone;
    case WireItem::kConstant:
      return raw.whole == op.value ? WireFlaw::kNone : WireFlaw::kConstant;
    case WireItem::kErrors:
      values.errors = static_cast<std::uint32_t>(raw.whole);
      return WireFlaw::kNone;
    case WireItem::kModel:
      values.model = static_cast<std::int32_t>(raw.whole);
      return WireFlaw::kNone;
    case WireItem::kTemperature:
    case WireItem::kVoltage: {
      const double value =
          op.exact ? static_cast<double>(raw.whole) : raw.real * op.scale + op.offset;
      (op.item == WireItem::kVoltage ? values.voltage : values.temperature[op.axis]) =
          static_cast<float>(value);
      return WireFlaw::kNone;
    }
    case WireItem::kIgnored:
      return WireFlaw::kNone;
  }
  return WireFlaw::kNone;
}

/// Returns the raw value of a field to write.
inline Raw raw_of(const WireOp& op, const WireValues& values) noexcept {
  const auto scaled = [&op](double value) noexcept {
    double raw = op.exact ? value : (value - op.offset) * op.to_raw;
    raw = std::min(std::max(raw, op.raw_min), op.raw_max);
    if (!(raw == raw)) raw = 0;
    // Values of up to 32 bits are rounded; no wider one is scaled.
    const bool small = std::abs(raw) < 2147483648.0;
    return Raw{small ? round_half_away(raw) : static_cast<std::int64_t>(raw), raw};
  };
  const auto whole = [&](std::int64_t value) noexcept {
    // Counters wrap at the width of their field, those of a text at the stated one.
    if (op.wrap > 0) value = sign_extended(static_cast<std::uint64_t>(value), op.wrap);
    return op.exact ? Raw{value, static_cast<double>(value)} : scaled(static_cast<double>(value));
  };
  switch (op.item) {
    case WireItem::kEncoder:
      return whole(values.encoders[op.axis]);
    case WireItem::kGimbal:
      return whole(values.gimbal[op.axis]);
    case WireItem::kButtons:
      return whole(values.buttons);
    case WireItem::kSequence:
      return whole(values.sequence);
    case WireItem::kTime:
      return whole(values.time);
    case WireItem::kMotor:
      return scaled(motor_value(op, values.motors[op.axis]));
    case WireItem::kConstant:
      return Raw{op.value, static_cast<double>(op.value)};
    case WireItem::kErrors:
      return whole(values.errors);
    case WireItem::kModel:
      return whole(values.model);
    case WireItem::kTemperature:
      return scaled(values.temperature[op.axis]);
    case WireItem::kVoltage:
      return scaled(values.voltage);
    case WireItem::kIgnored:
      break;
  }
  return {};
}

/// Returns whether a byte may follow the last number of a line.
bool is_line_end(std::byte byte) noexcept {
  return byte == std::byte{'\n'} || byte == std::byte{'\r'} || byte == std::byte{0};
}

/// Returns the mark without the bytes of a line's end.
std::span<const std::byte> without_line_end(const WireMark& mark) noexcept {
  std::size_t size = mark.size;
  while (size > 0 && is_line_end(mark.bytes[size - 1])) --size;
  return mark.span().first(size);
}

}  // namespace

const char* describe(WireFlaw flaw) noexcept {
  switch (flaw) {
    case WireFlaw::kNone:
      return "valid";
    case WireFlaw::kSize:
      return "wrong length";
    case WireFlaw::kMark:
      return "wrong mark";
    case WireFlaw::kCheck:
      return "wrong check value";
    case WireFlaw::kStuffing:
      return "wrong byte stuffing";
    case WireFlaw::kConstant:
      return "another value than the constant";
    case WireFlaw::kDigit:
      return "not a number";
    case WireFlaw::kErrors:
      return "the error flags make it unusable";
  }
  return "";
}

std::span<const std::byte> WireLayout::end_of_text() const noexcept {
  const auto significant = without_line_end(end);
  return significant.empty() ? end.span() : significant;
}

bool WireLayout::has(WireItem item) const noexcept {
  return std::any_of(ops.begin(), ops.begin() + static_cast<std::ptrdiff_t>(op_count),
                     [item](const WireOp& op) { return op.item == item; });
}

bool WireLayout::is_sound(std::span<const std::byte> frame) const noexcept {
  if (size == 0) return false;
  std::size_t length = size;
  if (framing == WireFraming::kLength) length = length_of(frame);
  if (length == 0 || frame.size() < length) return false;
  const auto body = frame.first(length);
  if (!starts_with(body, begin.span())) return false;
  if (!starts_with(body.last(end.size), end.span())) return false;
  if (check_bytes == 0) return true;
  const std::size_t at = length - (size - check_at);
  const std::uint64_t found =
      load_bytes(body.data() + at, static_cast<unsigned>(check_bytes), check_big_endian);
  return found == checksum.of(body.subspan(check_from, at - check_from));
}

std::size_t WireLayout::length_of(std::span<const std::byte> bytes) const noexcept {
  if (bytes.size() <= length_at) return 0;
  const std::size_t length = std::to_integer<std::size_t>(bytes[length_at]) + length_adds;
  const std::size_t before = std::max(length_at, check_bytes > 0 ? check_from : 0) + 1;
  return length < before + check_bytes + end.size || length > kWireSizeMax ? 0 : length;
}

WireVerdict WireLayout::read(std::span<const std::byte> frame, WireValues& values) const noexcept {
  if (framing == WireFraming::kText) return read_text(frame, values);
  if (framing == WireFraming::kCobs) {
    std::array<std::byte, kReportCapacity> body;
    const auto used = std::span<std::byte>(body).first(size);
    if (!take_cobs(frame, used)) return verdict(WireFlaw::kStuffing);
    return read_block(used, values);
  }
  if (framing == WireFraming::kSlip) {
    std::array<std::byte, kWireSlipSizeMax> body;
    const auto used = std::span<std::byte>(body).first(size);
    if (!take_slip(frame, used)) return verdict(WireFlaw::kStuffing);
    return read_block(used, values);
  }
  if (framing == WireFraming::kLength) {
    if (frame.size() < size || length_of(frame) != frame.size()) {
      return verdict(WireFlaw::kSize, length_at);
    }
    return read_block(frame, values);
  }
  if (frame.size() != size && frame.size() != padded) {
    return verdict(WireFlaw::kSize, std::min<std::size_t>(frame.size(), 255));
  }
  return read_block(frame.first(size), values);
}

WireVerdict WireLayout::read_block(std::span<const std::byte> body,
                                   WireValues& values) const noexcept {
  if (!starts_with(body, begin.span())) return verdict(WireFlaw::kMark);
  if (end.size > 0 && !starts_with(body.last(end.size), end.span())) {
    return verdict(WireFlaw::kMark, body.size() - end.size);
  }
  if (check_bytes > 0) {
    // With kLength, the message may be longer than `size`.
    const std::size_t at = body.size() - (size - check_at);
    const std::uint64_t found =
        load_bytes(body.data() + at, static_cast<unsigned>(check_bytes), check_big_endian);
    if (found != checksum.of(body.subspan(check_from, at - check_from))) {
      return verdict(WireFlaw::kCheck, at);
    }
  }
  WireValues fresh;
  std::uint32_t unusable = 0;
  std::size_t errors_at = 0;
  for (std::size_t i = 0; i < op_count; ++i) {
    const WireOp& op = ops[i];
    Raw raw;
    if (!read_raw(op, body.data(), raw)) return verdict(WireFlaw::kDigit, op.at, i);
    const WireFlaw flaw = take(op, raw, fresh);
    if (flaw != WireFlaw::kNone) return verdict(flaw, op.at, i);
    if (op.item == WireItem::kErrors) {
      unusable = fresh.errors & op.reject;
      errors_at = i;
    }
  }
  values = fresh;
  if (unusable != 0) return verdict(WireFlaw::kErrors, ops[errors_at].at, errors_at);
  return {};
}

WireVerdict WireLayout::read_text(std::span<const std::byte> line,
                                  WireValues& values) const noexcept {
  if (line.empty() || line.size() > size) return verdict(WireFlaw::kSize);
  if (!starts_with(line, begin.span())) return verdict(WireFlaw::kMark);
  const char* const first = reinterpret_cast<const char*>(line.data());
  const char* at = first + begin.size;
  const char* const last = first + line.size();
  const auto place = [&] { return static_cast<std::size_t>(at - first); };
  const auto rest = [&] { return line.subspan(place()); };
  WireValues fresh;
  std::uint32_t unusable = 0;
  std::size_t errors_at = 0;
  for (std::size_t i = 0; i < op_count; ++i) {
    const WireOp& op = ops[i];
    if (i > 0) {
      if (!starts_with(rest(), separator.span())) return verdict(WireFlaw::kMark, place(), i);
      at += separator.size;
    }
    Raw raw;
    if (op.type == WireType::kNumber) {
      std::int32_t number = 0;
      const auto [after, failure] = std::from_chars(at, last, number);
      if (failure != std::errc()) return verdict(WireFlaw::kDigit, place(), i);
      at = after;
      raw = {number, static_cast<double>(number)};
    } else {
      const char* const after = read_decimal(at, last, raw.real);
      if (after == nullptr) return verdict(WireFlaw::kDigit, place(), i);
      at = after;
      raw.whole = count_of(raw.real);
    }
    const WireFlaw flaw = take(op, raw, fresh);
    if (flaw != WireFlaw::kNone) return verdict(flaw, place(), i);
    if (op.item == WireItem::kErrors) {
      unusable = fresh.errors & op.reject;
      errors_at = i;
    }
  }
  const auto last_mark = without_line_end(end);
  if (!starts_with(rest(), last_mark)) return verdict(WireFlaw::kMark, place());
  for (at += last_mark.size(); at != last; ++at) {
    if (!is_line_end(static_cast<std::byte>(*at))) return verdict(WireFlaw::kMark, place());
  }
  values = fresh;
  if (unusable != 0) return verdict(WireFlaw::kErrors, 0, errors_at);
  return {};
}

std::size_t WireLayout::write(const WireValues& values,
                              std::span<std::byte, kReportCapacity> bytes) const noexcept {
  if (framing == WireFraming::kText) return write_text(values, bytes);
  std::array<std::byte, kReportCapacity> stuffed;
  const bool stuffs = framing == WireFraming::kCobs || framing == WireFraming::kSlip;
  std::byte* const body = stuffs ? stuffed.data() : bytes.data();
  std::memcpy(body, blank.data(), size);
  for (std::size_t i = 0; i < op_count; ++i) {
    if (ops[i].item == WireItem::kIgnored || ops[i].shown_only) continue;
    write_raw(ops[i], body, raw_of(ops[i], values));
  }
  if (check_bytes > 0) {
    const auto covered =
        std::span<const std::byte>(body, size).subspan(check_from, check_at - check_from);
    store_bytes(body + check_at, static_cast<unsigned>(check_bytes), check_big_endian,
                checksum.of(covered));
  }
  if (framing == WireFraming::kCobs) {
    return put_cobs(std::span<const std::byte>(body, size), bytes);
  }
  if (stuffs) return put_slip(std::span<const std::byte>(body, size), bytes);
  return size;
}

std::size_t WireLayout::write_text(const WireValues& values,
                                   std::span<std::byte, kReportCapacity> bytes) const noexcept {
  char* const first = reinterpret_cast<char*>(bytes.data());
  char* const last = first + bytes.size();
  char* at = first;
  const auto put = [&](const WireMark& mark) noexcept {
    const auto room = static_cast<std::size_t>(last - at);
    const std::size_t count = std::min<std::size_t>(mark.size, room);
    std::memcpy(at, mark.bytes.data(), count);
    at += count;
  };
  put(begin);
  for (std::size_t i = 0; i < op_count; ++i) {
    const WireOp& op = ops[i];
    if (i > 0) put(separator);
    const Raw raw = raw_of(op, values);
    if (op.type == WireType::kNumber) {
      const auto [after, failure] = std::to_chars(at, last, raw.whole);
      if (failure != std::errc()) break;
      at = after;
    } else {
      at = write_decimal(at, last, raw.real, op.decimals);
    }
  }
  put(end);
  return static_cast<std::size_t>(at - first);
}

std::vector<double> WireLayout::values_of(std::span<const std::byte> frame) const {
  std::vector<double> shown;
  WireValues values;
  if (const WireVerdict read_well = read(frame, values);
      !read_well && read_well.flaw != WireFlaw::kErrors) {
    return shown;
  }
  for (std::size_t i = 0; i < op_count; ++i) {
    const WireOp& op = ops[i];
    switch (op.item) {
      case WireItem::kMotor:
        shown.push_back(motor_value(op, values.motors[op.axis]));
        break;
      case WireItem::kTemperature:
        shown.push_back(static_cast<double>(values.temperature[op.axis]));
        break;
      case WireItem::kVoltage:
        shown.push_back(static_cast<double>(values.voltage));
        break;
      default:
        shown.push_back(static_cast<double>(raw_of(op, values).whole) * op.scale + op.offset);
        break;
    }
  }
  return shown;
}

void WireTable::use_motors(const std::array<MotorDrive, 3>& drives) noexcept {
  for (WireLayout* layout : {&report, &command}) {
    for (std::size_t i = 0; i < layout->op_count; ++i) {
      WireOp& op = layout->ops[i];
      if (op.item != WireItem::kMotor || op.unit == WireUnit::kAmpere) continue;
      const double torque_constant = drives[op.axis].torque_constant;
      op.gain = op.unit == WireUnit::kNewtonMetre ? torque_constant : torque_constant / op.full;
    }
  }
}

bool WireTable::decode(std::span<const std::byte> frame, ArmReading& reading) const noexcept {
  WireValues values;
  if (!report.read(frame, values)) return false;
  reading.counts = values.encoders;
  reading.auxiliary = values.gimbal;
  reading.buttons = static_cast<std::uint16_t>(values.buttons);
  reading.number.reset();
  if (numbered) reading.number = static_cast<std::uint16_t>(values.sequence);
  if (timed) reading.number = static_cast<std::uint16_t>(values.time);
  return true;
}

std::size_t WireTable::encode(const std::array<double, 3>& amperes,
                              std::span<std::byte, kReportCapacity> bytes,
                              std::uint32_t number) const noexcept {
  WireValues values;
  values.motors = amperes;
  values.sequence = number;
  return command.write(values, bytes);
}

unsigned WireTable::sequence_bits() const noexcept {
  for (std::size_t i = 0; i < report.op_count; ++i) {
    const WireOp& op = report.ops[i];
    if (op.item == WireItem::kSequence && op.type != WireType::kNumber) {
      return std::min<unsigned>(op.bit_count, 16);
    }
  }
  return 16;
}

std::size_t WireTable::axes() const noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < command.op_count; ++i) {
    count += command.ops[i].item == WireItem::kMotor ? 1 : 0;
  }
  return count;
}

}  // namespace thimble::driver
