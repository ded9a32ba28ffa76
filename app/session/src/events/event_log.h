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
  std::string name = {};                  ///< Stands in every line.
  std::string what = {};                  ///< What is run with which arm, for the first line.
  std::string limits = {};                ///< That are in force, in a sentence; may be empty.
  std::vector<std::string> objects = {};  ///< By the numbers of TickRecord::object.
  std::int64_t period_ns = 1'000'000;
  /// Of the loop's clock at the moment of making it; events in real time stand in the log with the
  /// time at which they happened.
  std::int64_t now_ns = 0;
  /// Whether the loop runs in real time; a thread of its own writes then, and between two ticks
  /// otherwise, where a tick lasts as long as it computes.
  bool real_time = false;
};

/// The log of what happens in a run: the arm opened, forces let through and off, faults, what the
/// gate did. The servo leaves events in a ring and never writes; where the ring is full, events are
/// counted and the log says how many it lacks.
class EventLog final : public TickObserver {
 public:
  /// Room for events on their way. [chosen: a second in which a tick of 1 kHz leaves four]
  static constexpr std::size_t kRingEvents = 4096;

  /// Begins the log of a run on `device`, which must outlive it.
  /// Real-time: never from the servo thread.
  EventLog(LoggedRun run, const driver::Device& device);
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;
  /// Writes what is left and how the run ended. After the last tick.
  ~EventLog() override;

  /// Takes one tick. Real-time: safe in a run in real time; in virtual time it writes.
  void take(const driver::TickRecord& record) noexcept override;

 private:
  void serve() noexcept;
  void write(const TickEvent& event);

  LoggedRun run_;
  const driver::Device& device_;
  std::shared_ptr<spdlog::logger> log_;
  std::chrono::system_clock::time_point clock_began_;  // when the loop's clock showed zero
  DeviceCounters counters_;
  SpscRing<TickEvent> ring_{kRingEvents};
  EventWatch watch_;
  std::uint64_t lost_told_ = 0;
  // Notices that the user got on the console: that a stage acts, and that it changes the force.
  std::array<std::array<bool, kActivities>, 2> given_{};
  std::atomic<bool> stop_{false};
  std::thread writer_;
};

}  // namespace thimble::session
