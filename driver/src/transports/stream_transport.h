#pragma once

#include <cstdint>

#include "thimble/driver/clock.h"
#include "thimble/driver/transport.h"
#include "transports/frame_finder.h"

namespace thimble::driver {

/// Counters of a byte stream, in addition to those of Device.
struct StreamCounters {
  std::uint64_t torn = 0;        ///< Messages started but never ended.
  std::uint64_t unanswered = 0;  ///< Messages sent while the previous one had no answer.
};

/// A wire that carries bytes without message borders, to an arm that sends only when asked. Common
/// part of serial ports and FTDI converters.
///
/// Ping-pong: the arm samples its encoders when a message arrives and answers at once. The loop
/// writes at the end of tick k and reads the answer at the beginning of tick k + 1. So positions
/// are one period old, less the travel time of the message: one tick of delay, the same in every
/// tick. (The first zero-force message of Device::open starts the exchange.) Waiting for the answer
/// inside the tick would save that delay only if the bus answered within a fraction of the period.
/// Full-speed USB, with its frames of 1 ms, does not.
///
/// A message is never held back, because the next may be the zero force that must go out. If the
/// last answer is still missing, `write` waits for it once, at most kTurn_ns. Otherwise two
/// messages could meet in the board, and Haptikfabriken boards then take neither. An arm that stays
/// silent is not waited for again.
class StreamTransport : public Transport {
 public:
  /// One frame of full-speed USB.
  static constexpr std::int64_t kTurn_ns = 1'000'000;

  TransportRead read_latest(std::span<std::byte> buffer, std::int64_t deadline_ns) noexcept final;
  TransportStatus write(std::span<const std::byte> report) noexcept final;

  /// Returns the counters of the stream. Real-time: safe.
  StreamCounters counters() const noexcept {
    return {.torn = finder_.torn(), .unanswered = unanswered_};
  }

 protected:
  /// Keeps the clock by reference; it must outlive the transport.
  StreamTransport(const Clock& clock, const Framing& framing) noexcept
      : clock_(clock), finder_(framing) {}

  /// Moves the bytes that have arrived into the finder, waiting up to `wait_ns` for the first byte.
  /// Returns kLost if the wire is gone, else kOk.
  virtual TransportStatus pump(std::int64_t wait_ns) noexcept = 0;

  /// Sends bytes.
  virtual TransportStatus put(std::span<const std::byte> bytes) noexcept = 0;

  FrameFinder& finder() noexcept { return finder_; }  ///< Returns the frame finder.

 private:
  bool awaiting() const noexcept { return spoken_ && finder_.found() == found_before_; }

  const Clock& clock_;
  FrameFinder finder_;
  std::uint64_t unanswered_ = 0;
  std::uint64_t found_before_ = 0;  // number of messages received when the last one was sent
  bool spoken_ = false;
  bool wait_expired_ = false;  // write waited without success since the last answer
  bool lost_ = false;
};

}  // namespace thimble::driver
