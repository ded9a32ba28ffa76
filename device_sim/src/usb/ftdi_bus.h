#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>

#include "thimble/device_sim/usb/usb_device.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/transport.h"
#include "transports/frame_finder.h"
#include "transports/serial_line.h"
#include "usb/usbip_session.h"

namespace thimble::device_sim::usb {

/// A full-speed bus with one FTDI converter on it, with frames of a millisecond; in each the host
/// takes the packets of the converter. Keeps a reference to the device. Real-time: safe.
class FtdiBus {
 public:
  static constexpr std::int64_t kFrame_ns = UsbDevice::kFrame_ns;

  FtdiBus(UsbDevice& device, std::int64_t time_ns) noexcept : device_(device), time_ns_(time_ns) {}

  std::int64_t time_ns() const noexcept { return time_ns_; }
  UsbDevice& device() noexcept { return device_; }

  /// Advances time within a frame.
  void advance_to(std::int64_t time_ns) noexcept;

  /// Advances to the beginning of the next frame and calls `take` with each packet that arrives.
  template <class Take>
  void frame(Take&& take) noexcept {
    advance_to((time_ns_ / kFrame_ns + 1) * kFrame_ns);
    std::array<std::byte, UsbDevice::kPacketMax> packet;
    for (int i = 0; i < UsbipSession::kBulkPackets; ++i) {
      const std::size_t size = read(packet);
      if (size == 0) return;
      take(std::span<const std::byte>(packet).first(size));
    }
  }

  /// Sends bytes now; false if the converter has no room for them.
  bool write(std::span<const std::byte> bytes) noexcept;

 private:
  std::size_t read(std::span<std::byte> packet) noexcept;

  UsbDevice& device_;
  std::int64_t time_ns_;
};

/// The serial line behind the bus, for the set-up; it waits in simulated time. Real-time: never
/// from the servo thread.
class FtdiBusLine final : public driver::SerialLine {
 public:
  explicit FtdiBusLine(FtdiBus& bus) noexcept : bus_(bus) {}

  bool set_rate_divisor(std::uint16_t divisor) override { return request(3, divisor); }
  bool set_frame_8n1() override { return request(4, 8) && request(2, 0); }
  bool set_rts(bool high) override { return request(1, high ? 0x0202 : 0x0200); }
  bool set_dtr(bool high) override { return request(1, high ? 0x0101 : 0x0100); }
  bool set_latency_ms(std::uint8_t latency_ms) override { return request(9, latency_ms); }
  bool purge() override;
  bool write(std::span<const std::byte> bytes) override;
  int read(std::span<std::byte> bytes, int timeout_ms) override;

 private:
  bool request(std::uint8_t number, std::uint16_t value);
  void step();

  FtdiBus& bus_;
  std::deque<std::byte> heard_;
};

/// The driver's transport to the converter. Frames pass with the clock; its time 0 is `begin_ns` of
/// the arm. Does not own the clock. Real-time: safe.
class FtdiBusTransport final : public driver::Transport {
 public:
  FtdiBusTransport(UsbDevice& device, driver::Clock& clock, const driver::Framing& framing,
                   std::int64_t begin_ns) noexcept
      : clock_(clock), finder_(framing), begin_ns_(begin_ns), bus_(device, begin_ns) {}

  driver::TransportRead read_latest(std::span<std::byte> buffer,
                                    std::int64_t deadline_ns) noexcept override;
  driver::TransportStatus write(std::span<const std::byte> report) noexcept override;

 private:
  void pass_frames() noexcept;

  driver::Clock& clock_;
  driver::FrameFinder finder_;
  std::int64_t begin_ns_;
  FtdiBus bus_;
};

}  // namespace thimble::device_sim::usb
