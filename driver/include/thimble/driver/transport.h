#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// How one exchange over the wire ended.
enum class TransportStatus : std::uint8_t {
  kOk,       ///< Bytes were read or written.
  kNothing,  ///< No new report arrived before the deadline.
  kLost,     ///< The arm is gone; every later call says so too.
  /// The arm is there, and whether it took the bytes is not known: it stalled, or is still busy
  /// with others, or an earlier message failed.
  kRefused,
};

/// How a read ended and how much of the buffer it filled.
struct TransportRead {
  TransportStatus status = TransportStatus::kNothing;  ///< What became of the read.
  std::size_t size = 0;       ///< Bytes of the newest report, 0 unless `status` is kOk.
  std::uint32_t skipped = 0;  ///< Older reports that were dropped in favour of the newest.
};

/// How messages stand out of a stream of bytes: by their first and last byte.
struct Framing {
  std::byte begin{};         ///< First byte of a message.
  std::byte end{};           ///< Last byte of a message.
  std::size_t size_max = 0;  ///< Longest message with both, at most kReportCapacity (arm.h).
};

/// Carries reports between the host and one arm; knows bytes, not what they mean.
///
/// Implementations neither allocate nor lock after they are opened. A transport is used by one
/// thread at a time. Its destructor closes the wire.
class THIMBLE_EXPORT Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Fills `buffer` with the newest report and drops older ones; a report longer than the buffer
  /// is cut. `deadline_ns` is on the loop's clock; a deadline in the past means "do not wait".
  /// Real-time: safe; waits no longer than the deadline.
  virtual TransportRead read_latest(std::span<std::byte> buffer,
                                    std::int64_t deadline_ns) noexcept = 0;

  /// Sends one report. Never answers kNothing; after kRefused the arm may have taken it or not.
  /// Real-time: safe; waits no longer than one transfer of the bus.
  virtual TransportStatus write(std::span<const std::byte> report) noexcept = 0;

  /// Returns what became of the last write, for a wire that takes messages before the arm does: kOk
  /// (it has left this computer), kNothing (it is on its way), kRefused or kLost. Real-time: safe;
  /// does not wait.
  virtual TransportStatus settled() noexcept { return TransportStatus::kOk; }
};

}  // namespace thimble::driver
