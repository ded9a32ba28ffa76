#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "events/tick_event.h"
#include "spsc_ring.h"
#include "thimble/driver/device.h"
#include "thimble/driver/export.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Counters in addition to the tick records, read on the servo thread at the end of each tick.
/// Real-time: safe, all functions.
class EventCounters {
 public:
  virtual ~EventCounters() = default;
  /// Returns a number that changes if, and only if, one of the counts below changes.
  virtual std::uint64_t changes() const noexcept = 0;
  /// Returns the number of occurrences of each activity; that of kMissedTicks is 0.
  virtual ActivityCounts activities() const noexcept = 0;
  /// Returns how often a lost link was replaced.
  virtual std::uint64_t links_replaced() const noexcept = 0;
  /// Returns the force of the workspace walls in the last tick in which one pushed, N in the world;
  /// zero without walls.
  virtual std::array<double, 3> f_wall_W() const noexcept { return {}; }
};

/// Counters of a device, which must outlive them.
class THIMBLE_EXPORT DeviceCounters final : public EventCounters {
 public:
  explicit DeviceCounters(const driver::Device& device) noexcept : device_(device) {}
  std::uint64_t changes() const noexcept override;
  ActivityCounts activities() const noexcept override;
  std::uint64_t links_replaced() const noexcept override;
  std::array<double, 3> f_wall_W() const noexcept override;

 private:
  const driver::Device& device_;
};

/// Detects events in the ticks of a run and puts each into a ring once. An activity is reported
/// when it begins and when it has been absent for kQuiet_ns, not in every tick. Real-time: safe.
class THIMBLE_EXPORT EventWatch final : public TickObserver {
 public:
  /// Time for which an activity must be absent to have ended, ns. [chosen: faster changes, such as
  /// those of the rise limit on a rough surface, are one event for a person]
  static constexpr std::int64_t kQuiet_ns = 100'000'000;

  /// Relative change of a force by a stage above which the user is informed, and its minimum
  /// duration, ns. [chosen: more than is felt (PHYSICS 6: 7 %), and longer than a stroke's impact]
  static constexpr double kChange = 0.1;
  static constexpr std::int64_t kChangeTime_ns = 200'000'000;

  /// Constructs a watch for ticks due every `period_ns`, with additional counters, which it counts
  /// from now on. Counters and ring must outlive it.
  EventWatch(const EventCounters& counters, std::int64_t period_ns,
             SpscRing<TickEvent>& ring) noexcept;

  /// Compares a tick with the previous one.
  void take(const driver::TickRecord& record) noexcept override;
  /// Ends all active activities. Call after the last tick, on any thread.
  void finish() noexcept;

  /// Returns the number of events lost because the ring was full. From any thread.
  std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::int64_t kNever_ns = INT64_MAX;
  static constexpr std::int64_t kLongAgo_ns = INT64_MIN / 2;

  /// Active activity.
  struct Episode {
    std::int64_t began_ns = 0;
    std::int64_t newest_ns = 0;
    std::uint64_t count = 0;           // 0: the activity has ended.
    std::array<double, 3> f_wall_W{};  // Largest force of the walls, N.
  };

  /// Consecutive ticks in which a stage changed the force by more than `kChange`.
  struct Change {
    std::int64_t began_ns = 0;
    std::int64_t newest_ns = kLongAgo_ns;
    bool reported = false;
  };

  bool quiet(const driver::TickRecord& record) const noexcept;
  void push(const TickEvent& event) noexcept;
  void examine(const driver::TickRecord& record) noexcept;
  void wait_for(const Episode& episode) noexcept;
  void watch_stage(const driver::TickRecord& record) noexcept;
  void watch_activities(const driver::TickRecord& record) noexcept;
  void watch_change(const driver::TickRecord& record, Activity activity, bool acted) noexcept;
  void end(Activity activity, Episode& episode) noexcept;

  const EventCounters& counters_;
  std::int64_t period_ns_;
  SpscRing<TickEvent>& ring_;
  std::uint64_t changes_;
  ActivityCounts counts_;
  std::uint64_t links_replaced_;
  std::array<Episode, kActivities> episodes_{};
  std::array<Change, kActivities> changes_of_force_{};
  std::int64_t earliest_end_ns_ = kNever_ns;  // No activity can end before this time.
  std::uint64_t tick_ = 0;
  std::int64_t time_ns_ = 0, due_ns_ = 0;
  bool begun_ = false;  // True if a tick was received.
  driver::DeviceStage stage_ = driver::DeviceStage::kIdle;
  driver::Fault fault_ = driver::Fault::kNone;
  driver::LinkState link_ = driver::LinkState::kConnected;
  bool touching_ = false;
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace thimble::session
