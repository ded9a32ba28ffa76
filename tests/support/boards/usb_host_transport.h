#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "support/boards/usb_host.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/transport.h"
#include "transports/frame_finder.h"
#include "transports/ftdi_packet.h"

namespace thimble::support {

/// A driver's wire through a host in this process. Bus frames of a millisecond pass with the
/// virtual clock. Two reads are always pending. A stalled endpoint is cleared, as the kernel does
/// for HID arms.
class UsbHostTransport final : public driver::Transport {
 public:
  /// Takes a configured host. `size` is the length of a report; with a framing, the arm is behind
  /// an FTDI converter. `in` and `out` are the numbers of the endpoints. Drops a report that waits
  /// in a HID board, as the kernel does when it opens one. Moves the clock to the time of the bus.
  UsbHostTransport(UsbHost& host, driver::VirtualClock& clock, std::size_t size,
                   std::optional<driver::Framing> framing = {}, std::uint8_t in = 1,
                   std::uint8_t out = 1)
      : host_(host),
        clock_(clock),
        size_(static_cast<std::uint32_t>(size)),
        in_(in),
        out_(framing ? std::uint8_t{2} : out) {
    if (framing) {
      finder_.emplace(*framing);
    } else {
      ask();
      host_.frames(2);
      collect();
      reports_.clear();
    }
    clock_.sleep_until_ns(host_.frame() * kFrame_ns);
  }

  driver::TransportRead read_latest(std::span<std::byte> buffer,
                                    std::int64_t deadline_ns) noexcept override {
    driver::TransportRead read;
    for (;;) {
      while ((host_.frame() + 1) * kFrame_ns <= clock_.now_ns()) {
        ask();
        host_.frames();
        collect();
      }
      if (host_.hung_up()) return {.status = driver::TransportStatus::kLost};
      if (ready() || clock_.now_ns() >= deadline_ns) break;
      clock_.sleep_until_ns(std::min(deadline_ns, clock_.now_ns() + kFrame_ns));
    }
    if (finder_) {
      read.size = finder_->take(buffer, read.skipped);
    } else if (!reports_.empty()) {
      read.size = std::min(buffer.size(), reports_.back().size());
      std::copy_n(reports_.back().begin(), read.size, buffer.begin());
      read.skipped = static_cast<std::uint32_t>(reports_.size() - 1);
      reports_.clear();
    }
    if (read.size > 0) read.status = driver::TransportStatus::kOk;
    return read;
  }

  driver::TransportStatus write(std::span<const std::byte> report) noexcept override {
    if (host_.hung_up()) return driver::TransportStatus::kLost;
    std::vector<std::byte> bytes(report.begin(), report.end());
    if (!finder_) bytes.resize(std::max<std::size_t>(bytes.size(), size_));
    bool refused = false;
    if (written_ != 0) {
      const auto done = host_.done(written_);
      refused = !done || done->status != 0;
      if (!done) return driver::TransportStatus::kRefused;
      if (done->status != 0) clear_halt(out_);
    }
    written_ = host_.tell(out_, bytes);
    if (finder_) host_.send_bulk(clock_.now_ns());
    return refused ? driver::TransportStatus::kRefused : driver::TransportStatus::kOk;
  }

 private:
  static constexpr std::int64_t kFrame_ns = device_sim::usb::UsbDevice::kFrame_ns;

  bool ready() const noexcept { return finder_ ? finder_->ready() : !reports_.empty(); }

  void ask() {
    for (std::uint32_t& asked : asked_) {
      if (asked == 0) asked = host_.ask(in_, finder_ ? 64 : size_);
    }
  }
  void collect() {
    for (std::uint32_t& asked : asked_) {
      const auto done = host_.done(asked);
      if (!done) continue;
      asked = 0;
      if (done->status == -32) clear_halt(static_cast<std::uint8_t>(0x80U | in_));
      if (done->status != 0) continue;
      if (finder_) {
        driver::for_each_ftdi_packet(done->data, [&](auto part) { finder_->push(part); });
      } else {
        reports_.push_back(done->data);
      }
    }
  }
  void clear_halt(std::uint8_t address) {
    host_.submit(false, 0, {}, 0,
                 {std::byte{0x02}, std::byte{1}, std::byte{0}, std::byte{0}, std::byte{address}});
  }

  UsbHost& host_;
  driver::VirtualClock& clock_;
  std::uint32_t size_;
  std::uint8_t in_, out_;
  std::optional<driver::FrameFinder> finder_;
  std::array<std::uint32_t, 2> asked_{};
  std::uint32_t written_ = 0;
  std::vector<std::vector<std::byte>> reports_;
};

}  // namespace thimble::support
