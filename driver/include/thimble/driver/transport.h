#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Status of one exchange over the wire.
enum class TransportStatus : std::uint8_t {
  kOk,       ///< Bytes were read or written.
  kNothing,  ///< No new report arrived before the deadline.
  kLost,     ///< Disconnected. Permanent: every later call returns this too.
  /// The arm is connected, but it is unknown whether it accepted the bytes: it stalled, is still
  /// busy with earlier messages, or an earlier message failed.
  kRefused,
};

/// Result of a read.
struct TransportRead {
  TransportStatus status = TransportStatus::kNothing;  ///< Status of the read.
  /// Size of the newest report, bytes; 0 unless `status` is kOk.
  std::size_t size = 0;
  /// Number of older reports dropped in favour of the newest.
  std::uint32_t skipped = 0;
};

class WireLayout;

/// Framing of messages in a byte stream, by their first and last byte or by a description.
struct Framing {
  std::byte begin{};  ///< First byte of a message.
  std::byte end{};    ///< Last byte of a message.
  /// Longest message including both bytes, at most kReportCapacity (arm.h).
  std::size_t size_max = 0;
  /// Messages of a described wire (internal); if not null, it replaces the other members. It must
  /// outlive the transport.
  const WireLayout* described = nullptr;
};

/// Carries reports between the host and one arm as bytes, independent of their meaning.
///
/// Implementations neither allocate nor lock after they are opened. A transport is used by one
/// thread at a time. Its destructor closes the connection.
class THIMBLE_EXPORT Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Reads the newest report into `buffer` and drops older ones; a report longer than the buffer is
  /// truncated. `deadline_ns` is on the loop's clock; a deadline in the past means "do not wait".
  /// Real-time: safe; waits no longer than the deadline.
  virtual TransportRead read_latest(std::span<std::byte> buffer,
                                    std::int64_t deadline_ns) noexcept = 0;

  /// Sends one report. Never returns kNothing. After kRefused it is unknown whether the arm
  /// accepted the report. Real-time: safe; waits no longer than one transfer of the bus.
  virtual TransportStatus write(std::span<const std::byte> report) noexcept = 0;

  /// Returns the result of the last write, for a transport that queues messages: kOk (the message
  /// has left this computer), kNothing (in transit), kRefused or kLost. Real-time: safe; does not
  /// wait.
  virtual TransportStatus settled() noexcept { return TransportStatus::kOk; }
};

}  // namespace thimble::driver
