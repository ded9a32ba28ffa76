#pragma once

#include <spdlog/logger.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "events/event_watch.h"
#include "events/tick_event.h"
#include "spsc_ring.h"
#include "thimble/driver/device.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Description of the run that an event log belongs to.
struct LoggedRun {
  std::string name = {};                  ///< Name of the run, in every line.
  std::string what = {};                  ///< Scene and arm, for the first line.
  std::string limits = {};                ///< Active limits in one sentence; may be empty.
  std::vector<std::string> objects = {};  ///< Names of the objects, by TickRecord::object.
  std::int64_t period_ns = 1'000'000;
  /// Time of the loop's clock at construction, ns; used to log events in real time with the time at
  /// which they occurred.
  std::int64_t now_ns = 0;
  /// True if the loop runs in real time. A separate thread then writes; otherwise the log is
  /// written between two ticks, which last as long as they compute.
  bool real_time = false;
};

/// Log of the events of a run: arm opened, forces enabled and disabled, faults, actions of the
/// gate. The servo puts events into a ring and never writes. If the ring is full, further events
/// are counted and the log reports their number.
class EventLog final : public TickObserver {
 public:
  /// Capacity of the ring, events. [chosen: a second in which a tick of 1 kHz produces four]
  static constexpr std::size_t kRingEvents = 4096;

  /// Starts the log of a run on `device`, which must outlive it. Real-time: never from the servo
  /// thread.
  EventLog(LoggedRun run, const driver::Device& device);
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;
  /// Writes the remaining events and the end of the run. Call after the last tick.
  ~EventLog() override;

  /// Receives one tick. Real-time: safe in a run in real time; writes in virtual time.
  void take(const driver::TickRecord& record) noexcept override;

 private:
  void serve() noexcept;
  void write(const TickEvent& event);

  LoggedRun run_;
  const driver::Device& device_;
  std::shared_ptr<spdlog::logger> log_;
  std::chrono::system_clock::time_point clock_began_;  // Time at which the loop's clock was zero.
  DeviceCounters counters_;
  SpscRing<TickEvent> ring_{kRingEvents};
  EventWatch watch_;
  std::uint64_t lost_reported_ = 0;
  // Notices printed on the console so far: that a stage acts, and that it changes the force.
  std::array<std::array<bool, kActivities>, 2> given_{};
  std::atomic<bool> stop_{false};
  std::thread writer_;
};

}  // namespace thimble::session
