#pragma once

#include <algorithm>
#include <array>
#include <deque>

#include "support/boards/usb_host.h"
#include "transports/serial_line.h"

namespace thimble::support {

/// An FTDI line through a host in this process, in simulated time with frames of a millisecond.
class UsbHostLine final : public driver::SerialLine {
 public:
  explicit UsbHostLine(UsbHost& host) : host_(host) {}
  ~UsbHostLine() override {
    // A pending read would take data of the next user of the host.
    if (asked_ != 0) host_.take_back(asked_);
  }

  bool set_rate_divisor(std::uint16_t divisor) override { return request(3, divisor); }
  bool set_frame_8n1() override { return request(4, 8) && request(2, 0); }
  bool set_rts(bool high) override { return request(1, high ? 0x0202 : 0x0200); }
  bool set_dtr(bool high) override { return request(1, high ? 0x0101 : 0x0100); }
  bool set_latency_ms(std::uint8_t latency_ms) override { return request(9, latency_ms); }
  bool purge() override {
    bytes_.clear();
    return request(0, 1) && request(0, 2);
  }
  bool write(std::span<const std::byte> bytes) override {
    const std::uint32_t sequence = host_.tell(2, bytes);
    for (int i = 0; i < 1000; ++i) {
      step();
      if (const auto done = host_.done(sequence)) return done->status == 0;
    }
    return false;
  }
  int read(std::span<std::byte> bytes, int timeout_ms) override {
    for (int i = 0; i < timeout_ms && bytes_.empty(); ++i) step();
    if (host_.hung_up()) return -1;
    const std::size_t size = std::min(bytes.size(), bytes_.size());
    std::copy_n(bytes_.begin(), size, bytes.begin());
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size));
    return static_cast<int>(size);
  }

 private:
  bool request(std::uint8_t number, std::uint16_t value) {
    const auto done = host_.control({.request_type = 0x40, .request = number, .value = value});
    collect();
    return done && done->status == 0;
  }
  void step() {
    if (asked_ == 0) asked_ = host_.ask(1, 64);
    host_.frames();
    collect();
  }
  void collect() {
    const auto done = host_.done(asked_);
    if (!done) return;
    asked_ = 0;
    if (done->data.size() > 2)
      bytes_.insert(bytes_.end(), done->data.begin() + 2, done->data.end());
  }

  UsbHost& host_;
  std::uint32_t asked_ = 0;
  std::deque<std::byte> bytes_;
};

}  // namespace thimble::support
