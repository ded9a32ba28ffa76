#pragma once

#include <cstddef>
#include <span>

namespace thimble::session {

/// Keeps this process alive where shared memory is cut short under it: reading a page that is gone
/// raises SIGBUS. For as long as this lives, such a page of `memory` becomes a page of zeros, and
/// `broken` tells. A SIGBUS from anywhere else ends the process as ever.
///
/// At most kMost of them live at a time; one more guards nothing.
class BusGuard {
 public:
  static constexpr std::size_t kMost = 16;

  /// Guards whole pages of memory that was mapped. Real-time: never from the servo thread.
  explicit BusGuard(std::span<std::byte> memory);
  BusGuard(const BusGuard&) = delete;
  BusGuard& operator=(const BusGuard&) = delete;
  ~BusGuard();

  /// Returns whether a page was gone. Real-time: safe.
  bool broken() const noexcept;

 private:
  std::size_t slot_ = kMost;
};

}  // namespace thimble::session
