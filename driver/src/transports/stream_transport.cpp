#include "transports/stream_transport.h"

namespace thimble::driver {

namespace {

// Each round either moves bytes or waits. The number of rounds bounds a stream that never ends and
// never forms a message.
constexpr int kRoundsMax = 4096;

}  // namespace

TransportRead StreamTransport::read_latest(std::span<std::byte> buffer,
                                           std::int64_t deadline_ns) noexcept {
  TransportRead read;
  std::int64_t wait_ns = 0;  // bytes that are already there come first, regardless of the deadline
  for (int round = 0; round < kRoundsMax && !lost_; ++round) {
    lost_ = pump(wait_ns) == TransportStatus::kLost;
    wait_ns = deadline_ns - clock_.now_ns();
    if (finder_.ready() || wait_ns <= 0) break;
  }
  if (finder_.ready() && !lost_) {
    read.status = TransportStatus::kOk;
    read.size = finder_.take(buffer, read.skipped);
  }
  if (lost_) read.status = TransportStatus::kLost;
  return read;
}

TransportStatus StreamTransport::write(std::span<const std::byte> report) noexcept {
  if (!awaiting()) wait_expired_ = false;
  if (awaiting() && !wait_expired_) {
    const std::int64_t until_ns = clock_.now_ns() + kTurn_ns;
    std::int64_t wait_ns = kTurn_ns;
    for (int round = 0; round < kRoundsMax && !lost_ && awaiting() && wait_ns > 0; ++round) {
      lost_ = pump(wait_ns) == TransportStatus::kLost;
      wait_ns = until_ns - clock_.now_ns();
    }
    wait_expired_ = awaiting();
  }
  if (lost_) return TransportStatus::kLost;
  if (awaiting()) ++unanswered_;
  finder_.forget_partial();
  const TransportStatus status = put(report);
  if (status == TransportStatus::kLost) lost_ = true;
  if (status == TransportStatus::kOk) {
    spoken_ = true;
    found_before_ = finder_.found();
  }
  return status;
}

}  // namespace thimble::driver
