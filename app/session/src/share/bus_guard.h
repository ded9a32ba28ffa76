#pragma once

#include <cstddef>
#include <span>

namespace thimble::session {

/// Protects this process against SIGBUS when another process truncates its shared memory. During
/// its lifetime a missing page of `memory` is replaced by zeros, and `broken` returns true. A
/// SIGBUS from another address ends the process as usual.
///
/// At most kMax guards are active at a time; a further one has no effect.
class BusGuard {
 public:
  static constexpr std::size_t kMax = 16;

  /// Guards whole pages of mapped memory. Real-time: never from the servo thread.
  explicit BusGuard(std::span<std::byte> memory);
  BusGuard(const BusGuard&) = delete;
  BusGuard& operator=(const BusGuard&) = delete;
  ~BusGuard();

  /// Returns whether a page was missing. Real-time: safe.
  bool broken() const noexcept;

 private:
  std::size_t slot_ = kMax;
};

}  // namespace thimble::session
