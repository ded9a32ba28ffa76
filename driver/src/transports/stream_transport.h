#pragma once

#include <cstdint>

#include "thimble/driver/clock.h"
#include "thimble/driver/transport.h"
#include "transports/frame_finder.h"

namespace thimble::driver {

/// Counts what a stream of bytes met, beyond what Device counts.
struct StreamCounters {
  std::uint64_t torn = 0;        ///< Messages begun and never ended.
  std::uint64_t unanswered = 0;  ///< Messages sent though the one before had no answer yet.
};

/// A wire that carries bytes without borders, to an arm that speaks only when spoken to: the
/// part that serial ports and FTDI converters have in common.
///
/// Ping-pong. The arm samples its encoders when a message reaches it and answers at once. The loop
/// writes at the end of tick k and reads the answer at the beginning of tick k + 1; so positions
/// are one period old, less the way of the message: one tick of delay, the same in every tick. (The
/// first zero-force message of Device::open starts the game.) To wait for the answer inside the
/// tick would save that delay only if the bus answered within a fraction of the period, which
/// full-speed USB with its frames of 1 ms does not.
///
/// A message is never held back, because the next may be the zero that must go out. If the answer
/// to the last one is still missing, `write` waits for it once, at most kTurn_ns, so that two
/// messages do not meet in the board (Haptikfabriken boards then take neither); an arm that stays
/// silent is not waited for again.
class StreamTransport : public Transport {
 public:
  /// One frame of full-speed USB.
  static constexpr std::int64_t kTurn_ns = 1'000'000;

  TransportRead read_latest(std::span<std::byte> buffer, std::int64_t deadline_ns) noexcept final;
  TransportStatus write(std::span<const std::byte> report) noexcept final;

  /// Returns what the stream met. Real-time: safe.
  StreamCounters counters() const noexcept {
    return {.torn = finder_.torn(), .unanswered = unanswered_};
  }

 protected:
  /// Keeps the clock by reference; it must outlive the transport.
  StreamTransport(const Clock& clock, const Framing& framing) noexcept
      : clock_(clock), finder_(framing) {}

  /// Moves what has arrived into the finder, waiting up to `wait_ns` for the first byte. Answers
  /// kLost if the wire is gone, else kOk.
  virtual TransportStatus pump(std::int64_t wait_ns) noexcept = 0;

  /// Sends bytes.
  virtual TransportStatus put(std::span<const std::byte> bytes) noexcept = 0;

  FrameFinder& finder() noexcept { return finder_; }  ///< Shows what finds messages.

 private:
  bool awaiting() const noexcept { return spoken_ && finder_.found() == found_before_; }

  const Clock& clock_;
  FrameFinder finder_;
  std::uint64_t unanswered_ = 0;
  std::uint64_t found_before_ = 0;  // messages that had come when the last one went out
  bool spoken_ = false;
  bool waited_out_ = false;  // write has waited in vain since the last answer
  bool lost_ = false;
};

}  // namespace thimble::driver
