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
    default:
      return read_shared_memory(rest);
  }
}

}  // namespace thimble::fuzz
