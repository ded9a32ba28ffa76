#include "fuzz/decoders.h"

#include <cstdio>
#include <cstdlib>

#include "thimble/driver/arms/falcon/falcon_arm.h"
#include "thimble/driver/arms/hfab/hfab_line.h"
#include "thimble/driver/arms/hfab/hfab_report.h"
#include "thimble/driver/arms/hfab/hfab_wire.h"
#include "thimble/driver/arms/woody/woody_wire.h"
#include "thimble/driver/frame_finder.h"
#include "thimble/driver/ftdi_packet.h"

namespace thimble::fuzz {
namespace {

using Bytes = std::span<const std::byte>;

void promise(bool kept, const char* what) {
  if (kept) return;
  std::fprintf(stderr, "A decoder broke its promise: %s\n", what);
  std::abort();
}

template <class Decode, class Encode>
bool comes_back(Bytes bytes, Decode decode, Encode encode, const char* what) {
  const auto meaning = decode(bytes);
  if (!meaning) return false;
  promise(decode(encode(*meaning)) == meaning, what);
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
  promise(size <= buffer.size(), "a line fits its buffer");
  promise(decode(Bytes(buffer).first(size)) == meaning, "a line means the same again");
  return true;
}

/// Cuts the bytes into pieces whose lengths they tell themselves, and finds messages.
bool find_frames(Bytes bytes) {
  driver::FrameFinder finder({.begin = std::byte{'<'}, .end = std::byte{'>'}, .size_max = 16});
  bool any = false;
  while (!bytes.empty()) {
    const std::size_t length =
        std::min<std::size_t>(bytes.size(), 1 + std::to_integer<unsigned>(bytes[0]) % 64);
    driver::for_each_ftdi_packet(bytes.first(length), [&](Bytes part) {
      promise(part.size() <= driver::kFtdiPacketSize - driver::kFtdiStatusSize,
              "a packet's content is shorter than the packet");
      finder.push(part);
    });
    bytes = bytes.subspan(length);
    std::array<std::byte, 16> buffer{};
    std::uint32_t skipped = 0;
    const std::size_t size = finder.take(buffer, skipped);
    if (size == 0) continue;
    any = true;
    promise(size >= 2 && size <= 16, "a message has the size it may have");
    promise(buffer[0] == std::byte{'<'} && buffer[size - 1] == std::byte{'>'},
            "a message has its borders");
  }
  return any;
}

/// What an arm makes of the bytes must be a pose or NaN, and a rejection leaves the reading alone.
template <class Wire>
bool reads(Bytes bytes) {
  driver::ArmReading reading{.counts = {11, 22, 33}, .auxiliary = {44, 55, 66}, .buttons = 77};
  if (Wire::decode(bytes, reading)) return true;
  promise(reading.counts == std::array<std::int32_t, 3>{11, 22, 33} && reading.buttons == 77,
          "a rejected report leaves the reading alone");
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
    default:
      return find_frames(rest);
  }
}

}  // namespace thimble::fuzz
