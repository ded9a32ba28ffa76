#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "board/port_board.h"
#include "support/boards/serial_board.h"

namespace thimble::support {

/// A simulated arm with a described wire over USB serial.
class DescribedBoard final : public SerialBoard {
 public:
  /// Takes an arm whose firmware uses the wire.
  DescribedBoard(device_sim::SimulatedArm arm, std::shared_ptr<const driver::WireTable> wire)
      : SerialBoard(std::move(arm)), board_(arm_, std::move(wire)) {}

  void advance_to(std::int64_t time_ns) noexcept override { board_.advance_to(time_ns); }
  device_sim::usb::PacketResult in(std::uint8_t, std::span<std::byte> packet) noexcept override {
    const std::size_t size = board_.say(packet.first(std::min(packet.size(), kPacketMax)));
    if (size == 0) return {device_sim::usb::Answer::kNak, 0};
    return {device_sim::usb::Answer::kDone, size};
  }
  device_sim::usb::PacketResult out(std::uint8_t,
                                    std::span<const std::byte> packet) noexcept override {
    board_.hear(packet);
    return {device_sim::usb::Answer::kDone, packet.size()};
  }

 private:
  device_sim::PortBoard board_;
};

}  // namespace thimble::support
