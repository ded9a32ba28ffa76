#include "board/sim_transport.h"

#include <algorithm>

namespace thimble::device_sim {

driver::TransportRead SimTransport::read_latest(std::span<std::byte> buffer,
                                                std::int64_t deadline_ns) noexcept {
  driver::TransportRead read;
  arm_.advance_to(clock_.now_ns());
  if (!plugged_) {
    read.status = driver::TransportStatus::kLost;
    return read;
  }
  read.size = arm_.take_report(buffer, read.skipped);
  // With jitter, the arrival time of a report is known only once it is sent.
  while (read.size == 0) {
    const std::int64_t until_ns = std::min(arm_.next_report_ns(), deadline_ns);
    if (!(until_ns > clock_.now_ns())) break;
    clock_.sleep_until_ns(until_ns);
    arm_.advance_to(clock_.now_ns());
    read.size = arm_.take_report(buffer, read.skipped);
  }
  if (read.size > 0) read.status = driver::TransportStatus::kOk;
  return read;
}

driver::TransportStatus SimTransport::write(std::span<const std::byte> report) noexcept {
  arm_.advance_to(clock_.now_ns());
  if (!plugged_) return driver::TransportStatus::kLost;
  arm_.put_message(report);
  return driver::TransportStatus::kOk;
}

}  // namespace thimble::device_sim
