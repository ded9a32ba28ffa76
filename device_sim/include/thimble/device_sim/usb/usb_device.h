#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/driver/export.h"

namespace thimble::device_sim::usb {

struct SetupPacket;
struct UsbDescription;

/// Response of a device to one packet or one control request.
enum class Answer : std::uint8_t {
  kDone,   ///< Success; `PacketResult::size` bytes were moved.
  kNak,    ///< Not ready; the host retries in a later frame.
  kStall,  ///< Refused; an endpoint stays halted until the host clears its halt.
  kGone,   ///< The device has left the bus.
};

/// Result of one packet.
struct PacketResult {
  Answer answer = Answer::kNak;  ///< Response to the packet.
  std::size_t size = 0;          ///< Number of bytes moved; more than the host requested is babble.
};

/// A USB device as seen from its own end of the cable: its description, and its response when the
/// host polls an endpoint. Independent of kernel, sockets and clocks. ControlPipe answers standard
/// requests from the description.
///
/// Nothing allocates after construction. All functions except the constructors are Real-time: safe.
class THIMBLE_EXPORT UsbDevice {
 public:
  /// Largest packet of a full-speed bus, bytes.
  static constexpr std::size_t kPacketMax = 64;
  /// Length of a frame, ns [USB 2.0, 5.3.3].
  static constexpr std::int64_t kFrame_ns = 1'000'000;

  UsbDevice() = default;
  UsbDevice(const UsbDevice&) = delete;
  UsbDevice& operator=(const UsbDevice&) = delete;
  virtual ~UsbDevice() = default;

  /// Returns the description of the device.
  virtual const UsbDescription& description() const noexcept = 0;

  /// Advances time to the start of a frame, ns since the device was connected.
  virtual void advance_to(std::int64_t time_ns) noexcept = 0;

  /// Answers a class or vendor request. `data` contains the host's data, or has room for the
  /// requested data.
  virtual PacketResult control(const SetupPacket& setup, std::span<std::byte> data) noexcept = 0;

  /// Writes one packet for the host from this endpoint (address with bit 7). The buffer holds at
  /// least kPacketMax bytes.
  virtual PacketResult in(std::uint8_t address, std::span<std::byte> packet) noexcept = 0;

  /// Receives one packet from the host.
  virtual PacketResult out(std::uint8_t address, std::span<const std::byte> packet) noexcept = 0;
};

}  // namespace thimble::device_sim::usb
