#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "simulated_arm.h"
#include "thimble/driver/export.h"
#include "transports/frame_finder.h"
#include "wires/wire_table.h"

namespace thimble::device_sim {

/// The board of a simulated arm with a described wire, behind a serial port: bytes in, bytes out.
/// It answers each valid command, or sends reports by itself (exchange: stream). It answers the
/// start-up messages of the description. Real-time: safe after construction.
class THIMBLE_EXPORT PortBoard {
 public:
  /// Keeps the arm by reference; it must use the wire (FirmwareSettings::described).
  PortBoard(SimulatedArm& arm, std::shared_ptr<const driver::WireTable> wire);

  /// Advances the arm. A board that streams then has a report for each period that ended.
  void advance_to(std::int64_t time_ns) noexcept;

  /// Takes bytes that the host has sent.
  void hear(std::span<const std::byte> bytes) noexcept;

  /// Moves up to `room.size()` bytes that wait for the host; returns their number.
  std::size_t say(std::span<std::byte> room) noexcept;

  /// Returns the number of commands taken, and of messages that were not valid.
  std::uint64_t commands() const noexcept { return arm_.firmware().counters().messages; }
  std::uint64_t refused() const noexcept { return arm_.firmware().counters().malformed; }

 private:
  void put(std::span<const std::byte> bytes) noexcept;
  bool hear_start(std::byte byte) noexcept;

  SimulatedArm& arm_;
  std::shared_ptr<const driver::WireTable> wire_;
  driver::FrameFinder heard_;
  // The last bytes from the host, for start-up messages.
  std::array<std::byte, 64> recent_{};
  std::size_t recent_size_ = 0;
  // Bytes that wait for the host. A host that does not read loses the newest ones.
  std::array<std::byte, 4096> waiting_{};
  std::size_t waiting_size_ = 0;
};

}  // namespace thimble::device_sim
