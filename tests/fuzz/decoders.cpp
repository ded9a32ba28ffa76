#include "fuzz/decoders.h"

#include <cstdio>
#include <cstdlib>

#include "arms/falcon/falcon_arm.h"
#include "arms/hfab/hfab_line.h"
#include "arms/hfab/hfab_report.h"
#include "arms/hfab/hfab_wire.h"
#include "arms/woody/woody_report.h"
#include "arms/woody/woody_wire.h"
#include "fuzz/shared_run_memory.h"
#include "transports/frame_finder.h"
#include "transports/ftdi_packet.h"
#include "transports/hid_descriptor.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"
#include "usb/usbip_session.h"
#include "usb/usbip_wire.h"
#include "view/input/space_mouse_report.h"
#include "wires/count_unwrap.h"
#include "wires/wire_table.h"

namespace thimble::fuzz {
namespace {

using Bytes = std::span<const std::byte>;

void check(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "Check of a decoder failed: %s\n", what);
  std::abort();
}

template <class Decode, class Encode>
bool comes_back(Bytes bytes, Decode decode, Encode encode, const char* what) {
  const auto meaning = decode(bytes);
  if (!meaning) return false;
  check(decode(encode(*meaning)) == meaning, what);
  return true;
}

template <class Line>
bool line_comes_back(Bytes bytes, std::optional<Line> (*decode)(Bytes) noexcept,
                     std::size_t (*encode)(
                         const Line&, std::span<std::byte, driver::hfab::kLineCapacity>) noexcept) {
  const auto meaning = decode(bytes);
  if (!meaning) return false;
  std::array<std::byte, driver::hfab::kLineCapacity> buffer{};
  const std::size_t size = encode(*meaning, buffer);
  check(size <= buffer.size(), "a line fits its buffer");
  check(decode(Bytes(buffer).first(size)) == meaning,
        "an encoded line is decoded to the same values");
  return true;
}

/// Cuts the bytes into pieces, whose lengths the bytes themselves specify, and finds messages.
bool find_frames(Bytes bytes) {
  driver::FrameFinder finder({.begin = std::byte{'<'}, .end = std::byte{'>'}, .size_max = 16});
  bool any = false;
  while (!bytes.empty()) {
    const std::size_t length =
        std::min<std::size_t>(bytes.size(), 1 + std::to_integer<unsigned>(bytes[0]) % 64);
    driver::for_each_ftdi_packet(bytes.first(length), [&](Bytes part) {
      check(part.size() <= driver::kFtdiPacketSize - driver::kFtdiStatusSize,
            "a packet's content is shorter than the packet");
      finder.push(part);
    });
    bytes = bytes.subspan(length);
    std::array<std::byte, 16> buffer{};
    std::uint32_t skipped = 0;
    const std::size_t size = finder.take(buffer, skipped);
    if (size == 0) continue;
    any = true;
    check(size >= 2 && size <= 16, "a message has a valid size");
    check(buffer[0] == std::byte{'<'} && buffer[size - 1] == std::byte{'>'},
          "a message has its delimiters");
  }
  return any;
}

/// Decodes the bytes as a report: the result must be a pose or NaN, and a rejected report must not
/// change the reading.
template <class Wire>
bool reads(Bytes bytes) {
  driver::ArmReading reading{.counts = {11, 22, 33}, .auxiliary = {44, 55, 66}, .buttons = 77};
  if (Wire::decode(bytes, reading)) return true;
  check(reading.counts == std::array<std::int32_t, 3>{11, 22, 33} && reading.buttons == 77,
        "a rejected report does not change the reading");
  return false;
}

/// Decodes the bytes as one message of a USB/IP client in each of its two phases.
bool usbip_decode(Bytes bytes) {
  namespace usb = device_sim::usb;
  usb::UsbipRequest request;
  const bool asked = usb::decode_request(bytes, request) == usb::Decode::kWhole;
  if (asked) {
    check(request.size <= bytes.size(), "a request lies within its bytes");
    const auto again = usb::encode_request(request);
    usb::UsbipRequest same;
    check(usb::decode_request(again, same) == usb::Decode::kWhole,
          "an encoded request is decoded to the same request");
    // A bus id that fills its field loses its last character to the terminating zero.
    check(request.bus_id.starts_with(same.bus_id), "an encoded bus id is decoded to the same id");
  }
  usb::UsbipCommand command;
  if (usb::decode_command(bytes, command) != usb::Decode::kWhole) return asked;
  check(command.size <= bytes.size() && command.length <= usb::kTransferMax,
        "a command lies within its bytes");
  const Bytes data = bytes.first(command.size).subspan(usb::kUsbipHeaderSize);
  usb::UsbipCommand same;
  check(usb::decode_command(usb::encode_command(command, data), same) == usb::Decode::kWhole,
        "an encoded command is decoded to the same command");
  check(same.sequence == command.sequence && same.setup == command.setup &&
            same.length == command.length && same.unlinked == command.unlinked,
        "a re-encoded command has the same values");
  return true;
}

/// Device with one endpoint of each kind, which accepts and returns everything that is requested.
class Obliging final : public device_sim::usb::UsbDevice {
 public:
  Obliging() {
    using device_sim::usb::TransferKind;
    description_.interfaces.resize(1);
    description_.interfaces[0].endpoints = {{0x81, TransferKind::kInterrupt, 8, 1},
                                            {0x01, TransferKind::kInterrupt, 8, 1},
                                            {0x82, TransferKind::kBulk, 64, 0},
                                            {0x02, TransferKind::kBulk, 64, 0}};
  }
  const device_sim::usb::UsbDescription& description() const noexcept override {
    return description_;
  }
  void advance_to(std::int64_t) noexcept override {}
  device_sim::usb::PacketResult control(const device_sim::usb::SetupPacket& setup,
                                        std::span<std::byte> data) noexcept override {
    check(data.size() <= setup.length,
          "a device is asked for at most the length in the setup packet");
    return {device_sim::usb::Answer::kDone, data.size()};
  }
  device_sim::usb::PacketResult in(std::uint8_t, std::span<std::byte> packet) noexcept override {
    check(packet.size() >= kPacketMax, "a device has room for a packet");
    return {device_sim::usb::Answer::kDone, ++count_ % 70};
  }
  device_sim::usb::PacketResult out(std::uint8_t,
                                    std::span<const std::byte> packet) noexcept override {
    check(packet.size() <= kPacketMax, "a packet does not exceed the maximum packet size");
    return {device_sim::usb::Answer::kDone, packet.size()};
  }

 private:
  device_sim::usb::UsbDescription description_;
  std::size_t count_ = 0;
};

/// Continues the session of a client that imported and configured a device with these bytes, in two
/// pieces.
bool usbip_session(Bytes bytes) {
  namespace usb = device_sim::usb;
  Obliging device;
  usb::UsbipSession session(device, "1-1");
  session.receive(
      usb::encode_request({.kind = usb::UsbipRequest::Kind::kImport, .bus_id = "1-1", .size = 0}),
      true);
  usb::UsbipCommand configure;
  configure.setup = {std::byte{0}, std::byte{9}, std::byte{1}};
  session.receive(usb::encode_command(configure), true);
  session.frame(0);
  session.output().clear();
  session.receive(bytes.first(bytes.size() / 2), true);
  session.frame(1'000'000);
  session.receive(bytes.subspan(bytes.size() / 2), true);
  session.send_bulk();
  for (int frame = 2; frame < 5; ++frame) session.frame(frame * 1'000'000);
  const auto& counters = session.counters();
  check(counters.completed + counters.stalled + counters.babbled + counters.unlinked <=
            counters.submitted,
        "there are no more answers than requests");
  return session.state() == usb::UsbipSession::State::kAttached && counters.completed > 1;
}

/// A report descriptor comes from a device that is not yet identified.
bool hid_descriptor(Bytes bytes) {
  constexpr std::size_t kLengthMax = 1U << 16;
  const driver::HidReports reports = driver::read_hid_descriptor(bytes);
  check(reports.in_bytes <= kLengthMax && reports.out_bytes <= kLengthMax,
        "a report has a valid length");
  return reports.in_bytes > 0;
}

/// A reading of a SpaceMouse is complete, or keeps the previous state.
bool space_mouse(Bytes bytes) {
  const view::SpaceMouseState before{.translation = {1, 2, 3}, .rotation = {4, 5, 6}};
  view::SpaceMouseState state = before;
  if (view::take_space_mouse_report(bytes, state)) return true;
  check(state == before, "a rejected report does not change the state");
  return false;
}

/// Returns a description with most representations, for one of the framings with marks.
driver::WireDescription description(driver::WireFraming kind) {
  using driver::WireItem;
  using driver::WireType;
  driver::WireDescription wire;
  wire.transport = driver::WireTransport::kSerial;
  const bool text = kind == driver::WireFraming::kText;
  for (driver::WireLayoutText* layout : {&wire.report, &wire.command}) {
    const bool report = layout == &wire.report;
    layout->framing = kind;
    layout->begin = {std::byte{'<'}};
    layout->separator = {std::byte{','}};
    if (text) layout->end = {std::byte{'>'}, std::byte{'\n'}};
    if (kind == driver::WireFraming::kLength) {
      layout->length_at = 14;
      layout->length_adds = 4;
    }
    if (!text) {
      layout->size = 20;
      layout->check = {
          .kind = driver::WireCheck::kCrc16, .polynomial = 0x1021, .initial = 0xffff, .at = 18};
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      driver::WireFieldText field;
      field.item = report ? WireItem::kEncoder : WireItem::kMotor;
      field.axis = axis;
      field.type = text ? WireType::kNumber : axis == 0 ? WireType::kNibbles : WireType::kSigned;
      field.minus = !text && axis == 0 ? 65 : 0;
      field.at = 1 + 4 * axis;
      field.bytes = 4;
      field.big_endian = axis == 1;
      field.scale = report ? 1 : 0.001;
      if (report && kind == driver::WireFraming::kLength && axis == 2) field.wrap = 12;
      layout->fields.push_back(field);
    }
    if (!text) {
      driver::WireFieldText buttons;
      buttons.item = WireItem::kButtons;
      buttons.at = 13;
      buttons.bit_first = 2;
      buttons.bit_last = 4;
      buttons.inverted = true;
      layout->fields.push_back(buttons);
      driver::WireFieldText constant = buttons;
      constant.item = WireItem::kConstant;
      constant.bit_first = 5;
      constant.bit_last = 7;
      constant.value = 5;
      layout->fields.push_back(constant);
    }
  }
  return wire;
}

constexpr std::array kFramings{driver::WireFraming::kHeader, driver::WireFraming::kText,
                               driver::WireFraming::kCobs, driver::WireFraming::kSlip,
                               driver::WireFraming::kLength};

/// Returns the wire of a framing, by its place in kFramings.
const driver::WireTable& described_wire(std::size_t place) {
  static const auto wires = [] {
    std::array<std::shared_ptr<const driver::WireTable>, kFramings.size()> all;
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = driver::compile_wire(description(kFramings[i])).table;
      check(all[i] != nullptr, "the described wire of this test is valid");
    }
    return all;
  }();
  return *wires[place];
}

/// Takes bytes as the reports of counters that wrap around.
void unwrap(Bytes bytes) {
  driver::CountUnwrap unwrap;
  const std::array<std::uint8_t, 3> bits{8, 16, 31};
  std::array<std::int32_t, 3> before{};
  bool any = false;
  for (; bytes.size() >= 12; bytes = bytes.subspan(12)) {
    std::array<std::int32_t, 3> counts{};
    std::memcpy(counts.data(), bytes.data(), sizeof counts);
    const auto raw = counts;
    if (!unwrap.take(bits, counts)) {
      check(counts == raw, "a refused step changes no count");
      continue;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t step = std::int64_t{counts[i]} - before[i];
      check(!any || std::abs(step) <= std::int64_t{1} << (bits[i] - 2),
            "a counter moves by a quarter of its range at most");
    }
    before = counts;
    any = true;
  }
}

/// Reads a message of a described wire, and the same bytes as a stream. The first byte selects the
/// wire.
bool described(Bytes bytes) {
  if (bytes.empty()) return false;
  const auto& wire = described_wire(std::to_integer<unsigned>(bytes[0]) % kFramings.size());
  bytes = bytes.subspan(1);
  unwrap(bytes);
  driver::FrameFinder finder({.described = &wire.report});
  finder.push(bytes);
  std::array<std::byte, driver::kReportCapacity> found{};
  std::uint32_t skipped = 0;
  check(finder.take(found, skipped) <= found.size(), "a message fits its buffer");
  driver::WireValues values, again;
  values.encoders = {11, 22, 33};
  if (!wire.report.read(bytes, values)) {
    check(values.encoders == std::array<std::int32_t, 3>{11, 22, 33},
          "a rejected report does not change the values");
    return false;
  }
  std::array<std::byte, driver::kReportCapacity> buffer{};
  const std::size_t size = wire.report.write(values, buffer);
  check(static_cast<bool>(wire.report.read(Bytes(buffer).first(size), again)) &&
            again.encoders == values.encoders && again.buttons == values.buttons,
        "an encoded report is decoded to the same values");
  return true;
}

/// Changes one property of a message, or of a field of it.
void change(driver::WireLayoutText& layout, unsigned property, unsigned value) {
  constexpr std::array kFactors{0.0, 1.0, -1.0, 0.001, 1e-300, 1e300, 65536.0, -0.5};
  const auto small = static_cast<int>(value % 70) - 1;
  driver::WireFieldText& field = layout.fields[value % layout.fields.size()];
  // The value also selects the field, so that one byte is enough.
  switch (property % 24) {
    case 0:
      layout.framing = static_cast<driver::WireFraming>(value % 6);
      break;
    case 1:
      layout.size = value % 140;
      break;
    case 2:
      layout.padded = value % 140;
      break;
    case 3:
      layout.begin.assign(value % 10, std::byte{0x3c});
      break;
    case 4:
      layout.end.assign(value % 10, static_cast<std::byte>(value));
      break;
    case 5:
      layout.separator.assign(value % 10, static_cast<std::byte>(value));
      break;
    case 6:
      layout.ignore.assign(value % 10, static_cast<std::byte>(value));
      break;
    case 7:
      layout.length_at = value % 140;
      break;
    case 8:
      layout.length_adds = value % 140;
      break;
    case 9:
      layout.check.kind = static_cast<driver::WireCheck>(value % 6);
      break;
    case 10:
      layout.check.at = value % 140;
      break;
    case 11:
      layout.check.from = value % 140;
      break;
    case 12:
      layout.check.reflected = value % 2 != 0;
      layout.check.big_endian = value % 3 == 0;
      break;
    case 13:
      field.at = value;
      break;
    case 14:
      field.bytes = value % 10;
      break;
    case 15:
      field.type = static_cast<driver::WireType>(value / 16 % 6);
      break;
    case 16:
      field.bit_first = small;
      break;
    case 17:
      field.bit_last = small;
      break;
    case 18:
      field.scale = kFactors[value / 8 % kFactors.size()];
      break;
    case 19:
      field.offset = kFactors[value / 8 % kFactors.size()];
      break;
    case 20:
      field.inverted = !field.inverted;
      field.minus = static_cast<int>(value);
      break;
    case 21:
      field.wrap = small;
      break;
    case 22:
      field.unit = static_cast<driver::WireUnit>(value / 16 % 4);
      field.full = kFactors[value / 8 % kFactors.size()];
      field.limit = kFactors[value / 4 % kFactors.size()];
      break;
    default:
      field.item = static_cast<driver::WireItem>(value / 16 % 12);
      field.reject = value;
      break;
  }
}

/// Checks that both directions of a compiled wire accept any bytes, and their own messages.
void use_layout(const driver::WireLayout& layout, Bytes bytes) {
  driver::FrameFinder finder({.described = &layout});
  driver::WireValues values, got;
  for (std::size_t i = 0; i < 3 && bytes.size() >= 4 * (i + 1); ++i) {
    std::memcpy(&values.encoders[i], &bytes[4 * i], 4);
    values.motors[i] = 1e-3 * values.encoders[i];
    values.gimbal[i] = ~values.encoders[i];  // the other sign, also for the smallest number
  }
  values.sequence = values.time = values.encoders[0];
  values.buttons = values.errors = static_cast<std::uint32_t>(values.encoders[1]);
  std::array<std::byte, driver::kReportCapacity> buffer{};
  const std::size_t size = layout.write(values, buffer);
  check(size <= buffer.size(), "a written message fits its buffer");
  const Bytes message = Bytes(buffer).first(size);
  const driver::WireVerdict verdict = layout.read(message, got);
  // A text may have a separator that looks like a digit.
  check(verdict || verdict.flaw == driver::WireFlaw::kErrors ||
            layout.framing == driver::WireFraming::kText,
        "a written message is valid");
  static_cast<void>(layout.values_of(message));
  finder.push(bytes);
  finder.push(message);
  std::array<std::byte, driver::kReportCapacity> found{};
  std::uint32_t skipped = 0;
  const std::size_t length = finder.take(found, skipped);
  check(length <= found.size(), "a message fits its buffer");
  static_cast<void>(layout.read(Bytes(found).first(length), got));
  static_cast<void>(layout.read(bytes, got));
}

/// Changes a valid description, two bytes for each change, and compiles it. The first byte selects
/// the description, the second the number of changes; bytes behind them are a message.
bool any_description(Bytes bytes) {
  if (bytes.size() < 2) return false;
  auto wire = description(kFramings[std::to_integer<unsigned>(bytes[0]) % kFramings.size()]);
  unsigned changes = std::to_integer<unsigned>(bytes[1]) % 8;
  bytes = bytes.subspan(2);
  for (; changes > 0 && bytes.size() >= 2; --changes, bytes = bytes.subspan(2)) {
    const auto property = std::to_integer<unsigned>(bytes[0]);
    change(property < 128 ? wire.report : wire.command, property % 128,
           std::to_integer<unsigned>(bytes[1]));
  }
  const driver::WireCompiled compiled = driver::compile_wire(wire);
  check((compiled.table == nullptr) == !compiled.mistakes.empty(),
        "a description has a table or mistakes");
  for (const driver::WireMistake& mistake : compiled.mistakes) {
    check(!mistake.sentence.empty(), "a mistake has a sentence");
  }
  if (compiled.table == nullptr) return false;
  driver::WireTable table = *compiled.table;
  std::array<driver::MotorDrive, 3> drives;
  drives.fill({.torque_constant = 0.02});
  table.use_motors(drives);
  use_layout(table.report, bytes);
  use_layout(table.command, bytes);
  return true;
}

}  // namespace

bool decode_anything(Bytes bytes) {
  namespace falcon = driver::falcon;
  namespace hfab = driver::hfab;
  namespace woody = driver::woody;
  if (bytes.empty()) return false;
  const unsigned target = std::to_integer<unsigned>(bytes[0]) % kTargets;
  const Bytes rest = bytes.subspan(1);
  switch (target) {
    case 0:
      return reads<hfab::ReportWire>(rest) &&
             comes_back(rest, hfab::decode_input, hfab::encode_input, "14-byte input");
    case 1:
      return comes_back(rest, hfab::decode_output, hfab::encode_output, "14-byte output");
    case 2:
      reads<hfab::LineWire>(rest);
      return line_comes_back<hfab::ArmLine>(rest, hfab::decode_arm_line, hfab::encode_arm_line);
    case 3:
      return line_comes_back<hfab::HostLine>(rest, hfab::decode_host_line, hfab::encode_host_line);
    case 4:
      return reads<woody::ReportWire>(rest) &&
             comes_back(rest, woody::decode_input, woody::encode_input, "8-byte input");
    case 5:
      return comes_back(rest, woody::decode_output, woody::encode_output, "8-byte output");
    case 6:
      return reads<falcon::PacketWire>(rest) &&
             comes_back(rest, falcon::decode_arm_packet, falcon::encode_arm_packet,
                        "packet to the host");
    case 7:
      return comes_back(rest, falcon::decode_host_packet, falcon::encode_host_packet,
                        "packet to the arm");
    case 8:
      return find_frames(rest);
    case 9:
      return usbip_decode(rest);
    case 10:
      return usbip_session(rest);
    case 12:
      return hid_descriptor(rest);
    case 13:
      return space_mouse(rest);
    case 14:
      return described(rest);
    case 15:
      return any_description(rest);
    default:
      return read_shared_memory(rest);
  }
}

}  // namespace thimble::fuzz
