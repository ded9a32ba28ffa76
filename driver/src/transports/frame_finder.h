#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/driver/arm.h"
#include "thimble/driver/export.h"
#include "thimble/driver/transport.h"

namespace thimble::driver {

/// Finds complete messages in a stream of bytes and keeps the newest. Total: accepts any bytes in
/// any pieces. All functions are Real-time: safe.
class THIMBLE_EXPORT FrameFinder {
 public:
  explicit FrameFinder(const Framing& framing) noexcept;

  /// Takes the next bytes of the stream.
  void push(std::span<const std::byte> bytes) noexcept;

  /// Drops the beginning of a message without marks, before the next request is sent. Other
  /// messages find their beginning again by their marks.
  void forget_partial() noexcept;

  /// Returns whether a message has arrived that was not taken yet.
  bool ready() const noexcept { return ready_ > 0; }

  /// Copies the newest message and removes it; returns its size, 0 if there is none. `skipped` is
  /// set to the number of older messages dropped. A message longer than the buffer is cut.
  std::size_t take(std::span<std::byte> buffer, std::uint32_t& skipped) noexcept;

  /// Returns the number of complete messages so far.
  std::uint64_t found() const noexcept { return found_; }

  /// Returns the number of torn messages: started but never ended, or too long.
  std::uint64_t torn() const noexcept { return torn_; }

 private:
  void push_described(std::span<const std::byte> bytes) noexcept;
  void take_text(std::byte byte) noexcept;
  void take_block(std::byte byte) noexcept;
  void take_measured(std::byte byte) noexcept;
  void keep(std::size_t size) noexcept;
  void drop(std::size_t size) noexcept;
  void emit() noexcept;

  Framing framing_;
  std::array<std::byte, kReportCapacity> growing_{}, newest_{};
  std::size_t growing_size_ = 0;  // 0: outside of a message
  std::size_t newest_size_ = 0;
  std::uint32_t ready_ = 0;
  std::uint64_t found_ = 0, torn_ = 0;
  bool joined_ = false;  // of a described text, COBS or SLIP: the beginning of a message is known
};

}  // namespace thimble::driver
