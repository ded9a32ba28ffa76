#include "bringup/wire_timing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "wires/described_link.h"

namespace thimble::bringup {
namespace {

using driver::TransportRead;
using driver::TransportStatus;

/// Counts the messages of a board and the times between them.
class Counter {
 public:
  Counter(const driver::Transport& port, const driver::WireTable& wire)
      : port_(port), wire_(wire), torn_before_(driver::torn_messages(port)) {
    if (wire.numbered) timing_.lost = timing_.repeated = 0;
  }

  /// Takes a message that arrived. Returns whether it is a valid report.
  bool take(std::span<const std::byte> message, std::uint32_t skipped, std::int64_t now_ns) {
    driver::WireValues values;
    const driver::WireVerdict verdict = wire_.report.read(message, values);
    const bool flagged = verdict.flaw == driver::WireFlaw::kErrors;
    // Skipped messages were complete; the newest one shows whether they were reports.
    if (!verdict && !flagged) {
      timing_.flaw = verdict;
      timing_.damaged += 1 + skipped;
      damaged_since_ += 1 + skipped;
      return false;
    }
    count_numbers(values, skipped);
    if (timing_.reports == 0) {
      first_ns_ = now_ns;
      at_first_ = 1 + skipped;
    }
    timing_.reports += 1 + skipped;
    timing_.unusable += flagged ? 1 : 0;
    last_ns_ = now_ns;
    return true;
  }

  void count_silence() { ++timing_.unanswered; }
  void add_time(std::int64_t ns) { times_.push_back(1e-9 * static_cast<double>(ns)); }
  void set_disconnected() { timing_.disconnected = true; }
  bool any() const { return timing_.reports > 0; }
  std::int64_t first_ns() const { return first_ns_; }
  std::int64_t last_ns() const { return last_ns_; }

  WireTiming result() {
    timing_.damaged += driver::torn_messages(port_) - torn_before_;
    timing_.duration = 1e-9 * static_cast<double>(last_ns_ - first_ns_);
    if (timing_.duration > 0) {
      timing_.rate = static_cast<double>(timing_.reports - at_first_) / timing_.duration;
    }
    if (times_.empty()) return timing_;
    std::sort(times_.begin(), times_.end());
    const auto count = static_cast<double>(times_.size());
    timing_.mean = std::accumulate(times_.begin(), times_.end(), 0.0) / count;
    timing_.p99 = times_[static_cast<std::size_t>(std::ceil(0.99 * count)) - 1];
    timing_.max = times_.back();
    return timing_;
  }

 private:
  void count_numbers(const driver::WireValues& values, std::uint32_t skipped) {
    if (!wire_.numbered) return;
    const std::uint32_t mask = (1U << wire_.sequence_bits()) - 1;
    const auto number = static_cast<std::uint32_t>(values.sequence) & mask;
    const std::uint64_t torn = driver::torn_messages(port_);
    if (any()) {
      const std::uint32_t missing = (number - number_ - 1 - skipped) & mask;
      const std::uint64_t damaged = damaged_since_ + (torn - torn_since_);
      // A number from behind is no loss of nearly all numbers.
      if (missing > mask / 2) {
        ++*timing_.repeated;
      } else if (missing > damaged) {
        *timing_.lost += missing - damaged;
      }
    }
    number_ = number;
    torn_since_ = torn;
    damaged_since_ = 0;
  }

  const driver::Transport& port_;
  const driver::WireTable& wire_;
  WireTiming timing_;
  std::vector<double> times_;  // s
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  std::size_t at_first_ = 0;                 // reports that arrived with the first one
  std::uint32_t number_ = 0;                 // of the last valid report
  std::uint64_t damaged_since_ = 0;          // damaged messages since then
  std::uint64_t torn_before_;                // driver::torn_messages at the beginning
  std::uint64_t torn_since_ = torn_before_;  // and at the last valid report
};

constexpr std::int64_t kFirst_ns = 3'000'000'000;  // [chosen: a board may restart when opened]
constexpr std::int64_t kPortWait_ns = 20'000'000;  // [chosen: so that Ctrl-C ends the wait soon]
constexpr std::int64_t kAnswer_ns = 100'000'000;   // [chosen: far above every board's answer]

}  // namespace

WireTiming time_stream(driver::Transport& port, const driver::WireTable& wire,
                       const driver::Clock& clock, double seconds, const std::atomic<bool>& stop) {
  Counter counter(port, wire);
  const auto length_ns = static_cast<std::int64_t>(1e9 * seconds);
  std::int64_t end_ns = clock.now_ns() + kFirst_ns;
  while (!stop.load() && clock.now_ns() < end_ns) {
    std::array<std::byte, driver::kReportCapacity> bytes{};
    const TransportRead read = port.read_latest(bytes, clock.now_ns() + kPortWait_ns);
    if (read.status == TransportStatus::kLost) {
      counter.set_disconnected();
      break;
    }
    if (read.status != TransportStatus::kOk) continue;
    const std::int64_t now_ns = clock.now_ns();
    const bool first = !counter.any();
    const std::int64_t before_ns = counter.last_ns();
    if (!counter.take(std::span<const std::byte>(bytes).first(read.size), read.skipped, now_ns)) {
      continue;
    }
    if (first) {
      end_ns = now_ns + length_ns;
      continue;
    }
    counter.add_time(now_ns - before_ns);
    // Several reports in one read: the others followed without a pause.
    for (std::uint32_t i = 0; i < read.skipped; ++i) counter.add_time(0);
  }
  return counter.result();
}

WireTiming time_answers(driver::Transport& port, const driver::WireTable& wire,
                        const driver::Clock& clock, double seconds, const std::atomic<bool>& stop) {
  Counter counter(port, wire);
  const std::int64_t end_ns = clock.now_ns() + static_cast<std::int64_t>(1e9 * seconds);
  std::uint32_t number = 0;
  while (!stop.load() && clock.now_ns() < end_ns) {
    std::array<std::byte, driver::kReportCapacity> bytes{};
    const std::size_t size = wire.encode({0, 0, 0}, bytes, ++number);
    const std::int64_t begin_ns = clock.now_ns();
    port.write(std::span<const std::byte>(bytes).first(size));
    const TransportRead read = port.read_latest(bytes, begin_ns + kAnswer_ns);
    if (read.status == TransportStatus::kLost) {
      counter.set_disconnected();
      break;
    }
    if (read.status != TransportStatus::kOk) {
      counter.count_silence();
      continue;
    }
    const std::int64_t now_ns = clock.now_ns();
    if (counter.take(std::span<const std::byte>(bytes).first(read.size), read.skipped, now_ns)) {
      counter.add_time(now_ns - begin_ns);
    }
  }
  return counter.result();
}

}  // namespace thimble::bringup
