#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "thimble/device_sim/usb/usb_device.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/transport.h"
#include "transports/frame_finder.h"
#include "transports/ftdi_packet.h"
#include "usb/usbip_session.h"

namespace thimble::support {

/// A driver's wire over a full-speed bus in this process. Its frames of a millisecond pass with the
/// virtual clock. It replaces the sockets of usb_host_transport.h in tests of many runs. It treats
/// its device as the kernel does:
/// - a HID report longer than requested is babble, and is dropped;
/// - a HID write waits until the arm accepts or rejects it, for up to 5 s;
/// - an endpoint that stalled rejects everything until it is cleared;
/// - a port or converter that cannot accept data rejects it at once;
/// - a device that left the bus is lost permanently;
/// - a report that waits in a HID board when it is opened is dropped (the kernel drops the reports
///   of the first 50 ms, linux/drivers/hid/usbhid/hid-core.c, usbhid_open).
class BusWire final : public driver::Transport {
 public:
  /// Transfer of the bytes.
  struct Way {
    std::uint8_t in = 0x81, out = 0x01;      ///< endpoints
    std::size_t report_size = 0;             ///< of a HID arm; 0: a byte stream without boundaries
    std::optional<driver::Framing> framing;  ///< of such a stream
    bool ftdi = false;                       ///< whether a converter adds its status
    std::int64_t begin_ns = 0;               ///< time of the device at the start of the clock
  };

  /// Keeps references to device and clock.
  BusWire(device_sim::usb::UsbDevice& device, driver::VirtualClock& clock, const Way& way)
      : device_(device), clock_(clock), way_(way), frame_(clock.now_ns() / kFrame_ns) {
    if (way.framing) finder_.emplace(*way.framing);
    std::array<std::byte, 2 * device_sim::usb::UsbDevice::kPacketMax> packet{};
    if (way.report_size > 0) device_.in(way_.in, packet);
  }

  driver::TransportRead read_latest(std::span<std::byte> buffer,
                                    std::int64_t deadline_ns) noexcept override {
    pass_frames();
    while (!lost_ && !ready() && clock_.now_ns() < deadline_ns) {
      clock_.sleep_until_ns(std::min(deadline_ns, (frame_ + 1) * kFrame_ns));
      pass_frames();
    }
    driver::TransportRead read;
    if (lost_) return {.status = driver::TransportStatus::kLost};
    if (finder_) {
      read.size = finder_->take(buffer, read.skipped);
    } else if (reports_ > 0) {
      read.size = std::min(buffer.size(), way_.report_size);
      std::copy_n(newest_.begin(), read.size, buffer.begin());
      read.size = std::min(read.size, newest_size_);
      read.skipped = reports_ - 1;
      reports_ = 0;
    }
    if (read.size > 0) read.status = driver::TransportStatus::kOk;
    return read;
  }

  driver::TransportStatus write(std::span<const std::byte> report) noexcept override {
    constexpr int kFramesMax = 5000;  // the kernel's time limit for a HID arm
    pass_frames();
    std::array<std::byte, device_sim::usb::UsbDevice::kPacketMax> padded{};
    std::copy_n(report.begin(), std::min(report.size(), padded.size()), padded.begin());
    const std::size_t size = finder_ ? report.size() : way_.report_size;
    for (int i = 0; i < kFramesMax && !lost_; ++i) {
      const auto result = device_.out(way_.out, std::span<const std::byte>(padded).first(size));
      if (result.answer == device_sim::usb::Answer::kDone) return driver::TransportStatus::kOk;
      lost_ = result.answer == device_sim::usb::Answer::kGone;
      if (lost_ || finder_ || result.answer == device_sim::usb::Answer::kStall) break;
      clock_.sleep_until_ns((frame_ + 1) * kFrame_ns);
      pass_frames();
    }
    return lost_ ? driver::TransportStatus::kLost : driver::TransportStatus::kRefused;
  }

 private:
  static constexpr std::int64_t kFrame_ns = device_sim::usb::UsbDevice::kFrame_ns;

  bool ready() const noexcept { return finder_ ? finder_->ready() : reports_ > 0; }

  void pass_frames() noexcept {
    while ((frame_ + 1) * kFrame_ns <= clock_.now_ns()) {
      ++frame_;
      device_.advance_to(way_.begin_ns + frame_ * kFrame_ns);
      poll();
    }
  }
  void poll() noexcept {
    constexpr int kBulkPackets = 19;  // of 64 bytes in a frame [USB 2.0, 5.8.4]
    for (int i = 0; i < (finder_ ? kBulkPackets : 1) && !lost_; ++i) {
      std::array<std::byte, 2 * device_sim::usb::UsbDevice::kPacketMax> packet{};
      const auto result = device_.in(way_.in, packet);
      lost_ = result.answer == device_sim::usb::Answer::kGone;
      if (result.answer != device_sim::usb::Answer::kDone || result.size == 0) return;
      const std::size_t max = finder_ ? device_sim::usb::UsbDevice::kPacketMax : way_.report_size;
      if (result.size > max) return;
      take(std::span<const std::byte>(packet).first(result.size));
    }
  }
  void take(std::span<const std::byte> packet) noexcept {
    if (!finder_) {
      ++reports_;
      newest_size_ = packet.size();
      std::copy(packet.begin(), packet.end(), newest_.begin());
    } else if (way_.ftdi) {
      driver::for_each_ftdi_packet(packet, [this](auto part) { finder_->push(part); });
    } else {
      finder_->push(packet);
    }
  }

  device_sim::usb::UsbDevice& device_;
  driver::VirtualClock& clock_;
  Way way_;
  std::int64_t frame_;
  std::optional<driver::FrameFinder> finder_;
  std::array<std::byte, device_sim::usb::UsbDevice::kPacketMax> newest_{};
  std::size_t newest_size_ = 0;
  std::uint32_t reports_ = 0;
  bool lost_ = false;
};

}  // namespace thimble::support
