#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "arms/hfab/hfab_line.h"
#include "arms/hfab/hfab_wire.h"
#include "support/boards/serial_board.h"
#include "transports/frame_finder.h"

namespace thimble::support {

/// A simulated arm that exchanges text lines over USB serial. The board sends nothing on its own
/// and answers every message with its counters. The answer to an invalid message repeats the last
/// counters, with the error of the published firmware.
class LineArm final : public SerialBoard {
 public:
  /// Takes an arm whose firmware uses text lines.
  explicit LineArm(device_sim::SimulatedArm arm) : SerialBoard(std::move(arm)) {}

  void advance_to(std::int64_t time_ns) noexcept override { arm_.advance_to(time_ns); }
  device_sim::usb::PacketResult in(std::uint8_t, std::span<std::byte> packet) noexcept override {
    if (waiting_ == 0) return {device_sim::usb::Answer::kNak, 0};
    const std::size_t size = std::min({waiting_, packet.size(), kPacketMax});
    std::copy_n(said_.begin(), size, packet.begin());
    std::copy(said_.begin() + static_cast<std::ptrdiff_t>(size),
              said_.begin() + static_cast<std::ptrdiff_t>(waiting_), said_.begin());
    waiting_ -= size;
    return {device_sim::usb::Answer::kDone, size};
  }
  device_sim::usb::PacketResult out(std::uint8_t,
                                    std::span<const std::byte> packet) noexcept override {
    heard_.push(packet);
    std::array<std::byte, driver::hfab::kLineCapacity> line{};
    std::uint32_t skipped = 0;
    if (const std::size_t size = heard_.take(line, skipped); size > 0) {
      answer(std::span<const std::byte>(line).first(size));
    }
    return {device_sim::usb::Answer::kDone, packet.size()};
  }

 private:
  void answer(std::span<const std::byte> line) noexcept {
    answer_.error = driver::hfab::kErrorParse;
    if (driver::hfab::decode_host_line(line)) {
      arm_.put_message(line);
      std::array<std::byte, driver::hfab::kLineCapacity> report{};
      std::uint32_t skipped = 0;
      const std::size_t size = arm_.take_report(report, skipped);
      const auto now =
          driver::hfab::decode_arm_line(std::span<const std::byte>(report).first(size));
      if (now) answer_ = *now;
      answer_.error = 0;
    }
    std::array<std::byte, driver::hfab::kLineCapacity> bytes{};
    const std::size_t size = driver::hfab::encode_arm_line(answer_, bytes);
    if (waiting_ + size > said_.size()) return;  // the host does not read
    std::copy_n(bytes.begin(), size, said_.begin() + static_cast<std::ptrdiff_t>(waiting_));
    waiting_ += size;
  }

  driver::FrameFinder heard_{driver::hfab::kLineFraming};
  driver::hfab::ArmLine answer_;
  std::array<std::byte, 4 * driver::hfab::kLineCapacity> said_{};
  std::size_t waiting_ = 0;
};

}  // namespace thimble::support
