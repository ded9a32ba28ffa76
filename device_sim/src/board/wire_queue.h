#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "thimble/driver/arm.h"

namespace thimble::device_sim {

/// A report or message in flight.
struct WireFrame {
  /// One byte more than any report has, so that an overlong message is still recognized as
  /// overlong.
  static constexpr std::size_t kCapacity = driver::kReportCapacity + 1;

  std::int64_t due_ns = 0;                   ///< Time of arrival, ns.
  std::size_t size = 0;                      ///< Number of valid bytes.
  std::array<std::byte, kCapacity> bytes{};  ///< Data; the first `size` bytes are valid.

  /// Returns the valid bytes.
  std::span<const std::byte> content() const noexcept {
    return std::span<const std::byte>(bytes).first(size);
  }
};

/// Frames in flight in one direction, in order of arrival. If the queue is full, the oldest frame
/// is dropped and counted. All functions are Real-time: safe.
class WireQueue {
 public:
  /// Max. number of frames in flight.
  static constexpr std::size_t kFrames = 256;

  /// Allocates memory for the frames; none if the wire is not `used`, that is, if bytes arrive at
  /// once and are never pushed. Real-time: never from the servo thread.
  explicit WireQueue(bool used) : frames_(used ? kFrames : 0) {}

  bool empty() const noexcept { return count_ == 0; }  ///< Returns whether no frame is in flight.

  /// Returns the next frame to arrive. Precondition: not empty (not checked; otherwise returns an
  /// old frame).
  const WireFrame& front() const noexcept { return frames_[first_]; }

  /// Sends bytes that will arrive at `due_ns`, but not before the frame sent last. Precondition:
  /// the wire is used.
  void push(std::span<const std::byte> bytes, std::int64_t due_ns) noexcept {
    if (count_ == room_) make_room();
    WireFrame& frame = frames_[(first_ + count_) & (room_ - 1)];
    frame.due_ns = due_ns;
    frame.size = std::min(bytes.size(), WireFrame::kCapacity);
    std::copy_n(bytes.begin(), frame.size, frame.bytes.begin());
    ++count_;
  }

  /// Removes the next frame; does nothing if there is none.
  void pop() noexcept {
    if (count_ == 0) return;
    --count_;
    // An empty queue restarts at slot 0: a wire without delay always uses one frame, which stays in
    // the cache.
    first_ = count_ == 0 ? 0 : (first_ + 1) & (room_ - 1);
  }

  /// Returns the number of frames lost because too many were in flight.
  std::uint64_t dropped() const noexcept { return dropped_; }

  /// Returns the memory of the first frame, the only one that is used while at most one is in
  /// flight; empty if the wire is not used. Real-time: safe.
  std::span<const std::byte> memory() const noexcept {
    return std::as_bytes(std::span(frames_).first(std::min<std::size_t>(1, frames_.size())));
  }

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
  // Ring size, a power of two. It grows only to the number of frames ever in flight, so that a wire
  // with delay also stays in the cache.
  std::size_t room_ = 4;
  std::uint64_t dropped_ = 0;
  std::vector<WireFrame> frames_;
};

}  // namespace thimble::device_sim
