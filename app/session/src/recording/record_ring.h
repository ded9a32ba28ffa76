#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// Hands ticks from the servo to one writer: neither waits for the other, nothing is lost while
/// there is room. All memory is there and touched when it is made.
class RecordRing {  // NOLINT(clang-analyzer-optin.performance.Padding): lines of their own below
 public:
  /// Makes room for `capacity` ticks (> 0). Real-time: never from the servo thread.
  explicit RecordRing(std::size_t capacity) : slots_(capacity) {}

  /// Adds a tick, or returns false if there is no room. The servo only. Real-time: safe.
  bool push(const driver::TickRecord& tick) noexcept {
    const std::uint64_t in = in_.load(std::memory_order_relaxed);
    if (in - out_.load(std::memory_order_acquire) == slots_.size()) return false;
    slots_[in % slots_.size()] = tick;
    in_.store(in + 1, std::memory_order_release);
    return true;
  }

  /// Tells how many ticks wait. Real-time: safe.
  std::size_t waiting() const noexcept {
    return static_cast<std::size_t>(in_.load(std::memory_order_acquire) -
                                    out_.load(std::memory_order_acquire));
  }

  /// Shows ticks that wait, oldest first: as many as lie in one piece. The writer only; valid until
  /// `drop`. Real-time: safe.
  std::span<const driver::TickRecord> front() const noexcept {
    const std::uint64_t out = out_.load(std::memory_order_relaxed);
    const auto waiting = static_cast<std::size_t>(in_.load(std::memory_order_acquire) - out);
    const std::size_t at = out % slots_.size();
    return {slots_.data() + at, std::min(waiting, slots_.size() - at)};
  }

  /// Gives the room of the `count` oldest ticks back. The writer only. Real-time: safe.
  void drop(std::size_t count) noexcept {
    out_.store(out_.load(std::memory_order_relaxed) + count, std::memory_order_release);
  }

 private:
  std::vector<driver::TickRecord> slots_;
  // On lines of the cache of their own: the two sides do not slow each other down.
  alignas(64) std::atomic<std::uint64_t> in_{0};
  alignas(64) std::atomic<std::uint64_t> out_{0};
};

}  // namespace thimble::session
