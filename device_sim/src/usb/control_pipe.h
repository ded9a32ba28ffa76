#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/device_sim/usb/usb_device.h"
#include "usb/setup_packet.h"

namespace thimble::device_sim::usb {

/// The control pipe of a device. It answers the standard requests of USB [USB 2.0, 9.4] and HID's
/// GET_DESCRIPTOR [HID 1.11, 7.1.1] from the description, keeps configuration and halted endpoints,
/// and passes all other requests to the device.
class ControlPipe {
 public:
  /// Keeps a reference to the device, which must outlive the pipe.
  explicit ControlPipe(UsbDevice& device) noexcept : device_(device) {}

  /// Executes one control transfer. `data` holds at most setup.length bytes: those that the host
  /// sends, or room for those that it requests. Real-time: never from the servo thread.
  PacketResult transfer(const SetupPacket& setup, std::span<std::byte> data);

  /// Returns whether an endpoint is halted. Real-time: safe.
  bool halted(std::uint8_t address) const noexcept;
  /// Halts an endpoint until the host clears it. Real-time: safe.
  void halt(std::uint8_t address) noexcept;
  /// Returns the configuration that the host selected, 0 for none. Real-time: safe.
  std::uint8_t configuration() const noexcept { return configuration_; }

 private:
  PacketResult standard(const SetupPacket& setup, std::span<std::byte> data);
  PacketResult feature(const SetupPacket& setup, bool set) noexcept;

  UsbDevice& device_;
  std::uint8_t configuration_ = 0;
  std::uint32_t halted_ = 0;  // one bit per endpoint number; endpoints to the host from bit 16
};

}  // namespace thimble::device_sim::usb
