#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/driver/arm.h"

namespace thimble::device_sim {

/// One report or message on its way.
struct WireFrame {
  /// One byte more than any report has, so that what was too long stays recognisable as such.
  static constexpr std::size_t kCapacity = driver::kReportCapacity + 1;

  std::int64_t due_ns = 0;                   ///< When it arrives.
  std::size_t size = 0;                      ///< Bytes that count.
  std::array<std::byte, kCapacity> bytes{};  ///< The first `size` count.

  /// Returns the bytes that count.
  std::span<const std::byte> content() const noexcept {
    return std::span<const std::byte>(bytes).first(size);
  }
};

/// Holds the frames in flight in one direction, in order of arrival. When it is full the oldest is
/// dropped and counted. All functions are Real-time: safe.
class WireQueue {
 public:
  /// How many frames may be in flight.
  static constexpr std::size_t kFrames = 256;

  bool empty() const noexcept { return count_ == 0; }  ///< Returns whether nothing waits.

  /// Returns the next frame to arrive. Precondition: not empty (the caller's duty; otherwise it is
  /// a frame of the past).
  const WireFrame& front() const noexcept { return frames_[first_]; }

  /// Sends bytes that will arrive at `due_ns`; if that lies before the time of the frame sent last,
  /// they arrive with that one.
  void push(std::span<const std::byte> bytes, std::int64_t due_ns) noexcept {
    if (count_ == room_) make_room();
    WireFrame& frame = frames_[(first_ + count_) & (room_ - 1)];
    frame.due_ns = due_ns;
    frame.size = std::min(bytes.size(), WireFrame::kCapacity);
    std::copy_n(bytes.begin(), frame.size, frame.bytes.begin());
    ++count_;
  }

  /// Takes the next frame away; does nothing if there is none.
  void pop() noexcept {
    if (count_ == 0) return;
    --count_;
    // An empty queue begins anew: a wire without delay writes to one frame, which stays in the
    // cache.
    first_ = count_ == 0 ? 0 : (first_ + 1) & (room_ - 1);
  }

  /// Returns how many frames were lost because too many were in flight.
  std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  [[gnu::noinline, gnu::cold]] void make_room() noexcept {
    if (room_ == kFrames) {
      pop();
      ++dropped_;
      return;
    }
    const auto begin = frames_.begin();
    std::rotate(begin, begin + static_cast<std::ptrdiff_t>(first_),
                begin + static_cast<std::ptrdiff_t>(room_));
    first_ = 0;
    room_ *= 2;
  }

  std::size_t first_ = 0;
  std::size_t count_ = 0;
  // Frames that are gone round: no more than were ever in flight, so that a wire with delay stays
  // in the cache too. A power of two.
  std::size_t room_ = 4;
  std::uint64_t dropped_ = 0;
  std::array<WireFrame, kFrames> frames_{};
};

}  // namespace thimble::device_sim
