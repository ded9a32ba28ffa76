#include "usb/control_pipe.h"
#include "usb/setup_packet.h"

#include <algorithm>
#include <array>
#include <vector>

#include "usb/usb_description.h"

namespace thimble::device_sim::usb {
namespace {

// Standard requests [USB 2.0, table 9-4].
enum Request : std::uint8_t {
  kGetStatus = 0,
  kClearFeature = 1,
  kSetFeature = 3,
  kSetAddress = 5,
  kGetDescriptor = 6,
  kGetConfiguration = 8,
  kSetConfiguration = 9,
  kGetInterface = 10,
  kSetInterface = 11,
};

constexpr std::uint16_t kEndpointHalt = 0;
constexpr std::uint8_t kSelfPoweredStatus = 1;

std::uint32_t halt_bit(std::uint16_t address) noexcept {
  return 1U << ((address & 0x0fU) + ((address & 0x80U) != 0 ? 16U : 0U));
}

PacketResult reply(std::span<const std::byte> answer, std::span<std::byte> data) noexcept {
  const std::size_t size = std::min(answer.size(), data.size());
  std::copy_n(answer.begin(), size, data.begin());
  return {Answer::kDone, size};
}

PacketResult done() noexcept {
  return {Answer::kDone, 0};
}

PacketResult stall() noexcept {
  return {Answer::kStall, 0};
}

}  // namespace

bool ControlPipe::halted(std::uint8_t address) const noexcept {
  return (halted_ & halt_bit(address)) != 0;
}

void ControlPipe::halt(std::uint8_t address) noexcept {
  halted_ |= halt_bit(address);
}

PacketResult ControlPipe::transfer(const SetupPacket& setup, std::span<std::byte> data) {
  if ((setup.request_type & kKindMask) == kKindStandard) return standard(setup, data);
  return device_.control(setup, data);
}

PacketResult ControlPipe::standard(const SetupPacket& setup, std::span<std::byte> data) {
  const std::uint8_t recipient = setup.request_type & 0x1fU;
  switch (setup.request) {
    case kGetDescriptor: {
      if (!setup.to_host()) return stall();
      // For a string the index is its language; there is only one.
      const bool of_interface = recipient == kRecipientInterface;
      const std::vector<std::byte> descriptor =
          build_descriptor(device_.description(), static_cast<std::uint8_t>(setup.value >> 8),
                           static_cast<std::uint8_t>(setup.value & 0xffU),
                           static_cast<std::uint8_t>(of_interface ? setup.index & 0xffU : 0));
      return descriptor.empty() ? stall() : reply(descriptor, data);
    }
    case kGetStatus: {
      if (!setup.to_host()) return stall();
      std::array<std::byte, 2> status{};
      if (recipient == kRecipientDevice) status[0] = std::byte{kSelfPoweredStatus};
      if (recipient == kRecipientEndpoint && (halted_ & halt_bit(setup.index)) != 0) {
        status[0] = std::byte{1};
      }
      return reply(status, data);
    }
    case kGetConfiguration:
    case kGetInterface: {
      if (!setup.to_host()) return stall();
      const std::array<std::byte, 1> value{
          static_cast<std::byte>(setup.request == kGetConfiguration ? configuration_ : 0)};
      return reply(value, data);
    }
    case kSetConfiguration:
      if (setup.to_host() || setup.value > 1) return stall();
      configuration_ = static_cast<std::uint8_t>(setup.value);
      halted_ = 0;
      return done();
    case kSetInterface:
      return !setup.to_host() && setup.value == 0 &&
                     setup.index < device_.description().interfaces.size()
                 ? done()
                 : stall();
    case kSetAddress:  // over usbip the host's controller does that itself; harmless
      return setup.to_host() ? stall() : done();
    case kClearFeature:
      return feature(setup, false);
    case kSetFeature:
      return feature(setup, true);
    default:
      return stall();
  }
}

PacketResult ControlPipe::feature(const SetupPacket& setup, bool set) noexcept {
  const bool endpoint = (setup.request_type & 0x1fU) == kRecipientEndpoint;
  if (setup.to_host() || !endpoint || setup.value != kEndpointHalt) return stall();
  const std::uint32_t bit = halt_bit(setup.index);
  halted_ = set ? halted_ | bit : halted_ & ~bit;
  return done();
}

}  // namespace thimble::device_sim::usb
