#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/driver/export.h"

namespace thimble::device_sim::usb {

struct SetupPacket;
struct UsbDescription;

/// How a device met one packet or one control request.
enum class Answer : std::uint8_t {
  kDone,   ///< Moved so many bytes.
  kNak,    ///< Not now; the host asks again in a later frame.
  kStall,  ///< Refused; an endpoint stays so until the host clears its halt.
  kGone,   ///< The device left the bus.
};

/// What became of one packet.
struct PacketResult {
  Answer answer = Answer::kNak;  ///< What became of the packet.
  std::size_t size = 0;          ///< Bytes moved; more than the host asked for is babble.
};

/// A USB device as its own side of the cable sees it: what it says of itself, and what it does
/// when the host polls an endpoint. It knows no kernel, no socket and no clock of its own. Standard
/// requests are not its business (ControlPipe answers them from the description).
///
/// Nothing here allocates after construction. All functions but the constructors are Real-time:
/// safe.
class THIMBLE_EXPORT UsbDevice {
 public:
  /// The largest packet of a full-speed bus, bytes.
  static constexpr std::size_t kPacketMax = 64;
  /// The length of a frame, ns [USB 2.0, 5.3.3].
  static constexpr std::int64_t kFrame_ns = 1'000'000;

  UsbDevice() = default;
  UsbDevice(const UsbDevice&) = delete;
  UsbDevice& operator=(const UsbDevice&) = delete;
  virtual ~UsbDevice() = default;

  /// Returns what the device is.
  virtual const UsbDescription& description() const noexcept = 0;

  /// Lets time pass up to the start of a frame, ns since the device was plugged in.
  virtual void advance_to(std::int64_t time_ns) noexcept = 0;

  /// Answers a class or vendor request. `data` holds what the host sends, or has room for what it
  /// asks for.
  virtual PacketResult control(const SetupPacket& setup, std::span<std::byte> data) noexcept = 0;

  /// Fills one packet for the host from this endpoint (address with bit 7). The buffer holds at
  /// least kPacketMax bytes.
  virtual PacketResult in(std::uint8_t address, std::span<std::byte> packet) noexcept = 0;

  /// Takes one packet from the host.
  virtual PacketResult out(std::uint8_t address, std::span<const std::byte> packet) noexcept = 0;
};

}  // namespace thimble::device_sim::usb
