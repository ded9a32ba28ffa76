#pragma once

#include <atomic>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>

#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/export.h"
#include "thimble/driver/force_law.h"
#include "thimble/driver/tick_record.h"

namespace thimble::driver {

/// Reference to a receiver of tick records: any object callable as `void sink(const TickRecord&)
/// noexcept` on the servo thread. Does not own the sink. Real-time: safe if the sink is.
class TickSink {
 public:
  /// Refers to a sink; copies the reference if it is a TickSink. Real-time: safe.
  template <class Sink>
  requires(!std::same_as<std::remove_const_t<Sink>, TickSink>) explicit TickSink(
      Sink& sink) noexcept
      : sink_(const_cast<void*>(static_cast<const void*>(&sink))),
        call_([](void* self, const TickRecord& record) noexcept {
          static_assert(noexcept((*static_cast<Sink*>(self))(record)),
                        "A tick sink runs on the servo thread and must be noexcept.");
          (*static_cast<Sink*>(self))(record);
        }) {}

  /// Passes the record of a tick to the sink. Real-time: safe if the sink is.
  void operator()(const TickRecord& record) const noexcept { call_(sink_, record); }

 private:
  void* sink_;
  void (*call_)(void*, const TickRecord&) noexcept;
};

/// Settings of a servo loop.
struct ServoSettings {
  std::int64_t period_ns = 1'000'000;  ///< Time between ticks, ns.
  /// Number of periods after which the loop ends (missed ticks count); 0: unlimited.
  std::uint64_t ticks = 0;
  /// Continues with zero force after a fault, so that positions are still read and a disconnected
  /// arm can return.
  bool continue_after_faults = false;
  /// Time before a tick at which the law prepares for it (ForceLaw::prepare) if the loop is not
  /// late, ns; 0: never. Affects only the duration of a tick, not the forces.
  std::int64_t prepare_ns = 0;

  /// Value for real-time loops, ns: 1 % of a tick at 1 kHz. Five times the 99th percentile of the
  /// duration of a contact with cold caches [measured: 2 us at 10^6 triangles].
  static constexpr std::int64_t kPrepare_ns = 10'000;
};

/// Reason for the end of a servo loop.
enum class ServoEnd : std::uint8_t {
  kDone,     ///< All periods have passed.
  kStopped,  ///< The stop flag was set.
  kFault,    ///< The device reported a fault; `Device::fault` names it.
};

/// Returns the name of an end reason in reports ("done"). Real-time: safe.
THIMBLE_EXPORT std::string_view name(ServoEnd end) noexcept;

/// Steppable servo loop, for callers that do work between ticks of virtual time. `run_servo` calls
/// it for all ticks.
///
/// Each tick waits (and lets the law prepare), reads, calls the law, writes, and calls the sink.
/// Ticks are due at fixed times. After a gap the missed ticks are skipped, not run in a burst. Used
/// by one thread.
class THIMBLE_EXPORT ServoLoop {
 public:
  /// Constructs a loop for an activated device. Device, clock, law and sink must outlive the loop.
  /// The first tick is due now. Real-time: safe.
  ServoLoop(Device& device, Clock& clock, ForceLaw law, TickSink sink,
            const ServoSettings& settings) noexcept;

  /// Runs the next tick. A suspend of the computer during it is the fault kSuspended. Returns the
  /// end reason once the periods are used up, `stop` is set, or this tick ended in a fault. Then
  /// zero force has been sent, repeatedly if the arm did not accept it (`Device::insist_on_zero`),
  /// and the device is idle or in fault. Later calls only return the same reason. Real-time: safe;
  /// waits until the tick is due.
  std::optional<ServoEnd> tick(const std::atomic<bool>& stop) noexcept;

 private:
  std::optional<ServoEnd> end_with(ServoEnd end) noexcept;
  void prepare() noexcept;
  void detect_suspend() noexcept;

  Device& device_;
  Clock& clock_;
  ForceLaw law_;
  TickSink sink_;
  ServoSettings settings_;
  std::int64_t due_ns_;
  std::int64_t end_ns_;
  std::int64_t asleep_ns_;  // Suspended time of the clock known so far.
  std::optional<ServoEnd> end_;
};

/// Runs a force law on a device until the periods are used up, `stop` is set, or the device is in
/// fault. Leaves the device idle (or in fault) with zero force sent. Real-time: safe; it is the
/// servo thread.
THIMBLE_EXPORT ServoEnd run_servo(Device& device, Clock& clock, ForceLaw law, TickSink sink,
                                  const ServoSettings& settings,
                                  const std::atomic<bool>& stop) noexcept;

}  // namespace thimble::driver
