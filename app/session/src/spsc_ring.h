#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace thimble::session {

/// Ring buffer that passes items from one thread to another (single producer, single consumer),
/// such as from the servo to a writer. Neither waits for the other, and no item is lost while there
/// is room. All memory is allocated and touched by the constructor.
template <class Item>
class SpscRing {  // NOLINT(clang-analyzer-optin.performance.Padding): separate cache lines below
  static_assert(std::is_trivially_copyable_v<Item>);

 public:
  /// Constructs a ring for `capacity` items (> 0). Real-time: never from the servo thread.
  explicit SpscRing(std::size_t capacity) : slots_(capacity) {}

  /// Adds an item; returns false if there is no room. Producer only. Real-time: safe.
  bool push(const Item& item) noexcept {
    const std::uint64_t in = in_.load(std::memory_order_relaxed);
    if (in - out_.load(std::memory_order_acquire) == slots_.size()) return false;
    slots_[in % slots_.size()] = item;
    in_.store(in + 1, std::memory_order_release);
    return true;
  }

  /// Returns the number of waiting items. Real-time: safe.
  std::size_t waiting() const noexcept {
    return static_cast<std::size_t>(in_.load(std::memory_order_acquire) -
                                    out_.load(std::memory_order_acquire));
  }

  /// Returns waiting items, oldest first, as far as they are contiguous. Consumer only; valid until
  /// `drop`. Real-time: safe.
  std::span<const Item> front() const noexcept {
    const std::uint64_t out = out_.load(std::memory_order_relaxed);
    const auto waiting = static_cast<std::size_t>(in_.load(std::memory_order_acquire) - out);
    const std::size_t at = out % slots_.size();
    return {slots_.data() + at, std::min(waiting, slots_.size() - at)};
  }

  /// Removes the `count` oldest items. Consumer only. Real-time: safe.
  void drop(std::size_t count) noexcept {
    out_.store(out_.load(std::memory_order_relaxed) + count, std::memory_order_release);
  }

 private:
  std::vector<Item> slots_;
  // On separate cache lines, so that the two sides do not slow each other down.
  alignas(64) std::atomic<std::uint64_t> in_{0};
  alignas(64) std::atomic<std::uint64_t> out_{0};
};

}  // namespace thimble::session
