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

/// Refers to whoever keeps the record of each tick: callable as `void sink(const TickRecord&)
/// noexcept` on the servo thread. Does not own it. Real-time: safe if the sink is.
class TickSink {
 public:
  /// Takes the sink to refer to; of a TickSink it is a copy. Real-time: safe.
  template <class Sink>
  requires(!std::same_as<std::remove_const_t<Sink>, TickSink>) explicit TickSink(
      Sink& sink) noexcept
      : sink_(const_cast<void*>(static_cast<const void*>(&sink))),
        call_([](void* self, const TickRecord& record) noexcept {
          static_assert(noexcept((*static_cast<Sink*>(self))(record)),
                        "A tick sink runs on the servo thread and must be noexcept.");
          (*static_cast<Sink*>(self))(record);
        }) {}

  /// Hands over the record of a tick. Real-time: safe if the sink is.
  void operator()(const TickRecord& record) const noexcept { call_(sink_, record); }

 private:
  void* sink_;
  void (*call_)(void*, const TickRecord&) noexcept;
};

/// Sets the pace of a servo loop.
struct ServoSettings {
  std::int64_t period_ns = 1'000'000;  ///< Time between ticks.
  std::uint64_t ticks =
      0;  ///< Ends after so many periods (missed ticks count); 0: never by itself.
  bool outlive_faults = false;  ///< Goes on with zero force after a fault, so that positions are
                                ///< still seen and a pulled arm can come back.
  /// How long before a tick the law prepares itself for it (ForceLaw::prepare), where the loop is
  /// not late; 0: never. Makes no difference to any force, only to how long a tick takes.
  std::int64_t prepare_ns = 0;

  /// For loops in real time: 1 % of a tick at 1 kHz. Five times the 99th of 100 of what a contact
  /// takes whose memory has grown cold [measured: 2 us at 10^6 triangles].
  static constexpr std::int64_t kPrepare_ns = 10'000;
};

/// Why a servo loop ended.
enum class ServoEnd : std::uint8_t {
  kDone,     ///< All periods have passed.
  kStopped,  ///< Somebody set the stop flag.
  kFault,    ///< The device reported a fault; `Device::fault` names it.
};

/// Returns how a report names an end ("done"). Real-time: safe.
THIMBLE_EXPORT std::string_view name(ServoEnd end) noexcept;

/// A servo loop, tick by tick, for whoever has something to do of his own between two ticks of
/// virtual time. `run_servo` is nothing but all its ticks.
///
/// Each tick: wait (and let the law prepare itself), read, ask the law, write, tell the sink. Ticks
/// are due at fixed times; after a gap the missed ones are skipped, not run in a burst. Used by one
/// thread.
class THIMBLE_EXPORT ServoLoop {
 public:
  /// Takes an activated device and what it runs with, all of which must outlive the loop. The first
  /// tick is due now. Real-time: safe.
  ServoLoop(Device& device, Clock& clock, ForceLaw law, TickSink sink,
            const ServoSettings& settings) noexcept;

  /// Runs the next tick; one that the computer slept through is the fault kSuspended. Returns why
  /// there is none any more, once the periods are used up, `stop` is set, or this tick ended in a
  /// fault; then the device has been left idle (or in fault) with zero force sent, insistently if
  /// the arm did not take it (`Device::insist_on_zero`), and later calls do nothing but tell the
  /// same. Real-time: safe; waits until the tick is due.
  std::optional<ServoEnd> tick(const std::atomic<bool>& stop) noexcept;

 private:
  std::optional<ServoEnd> end_with(ServoEnd end) noexcept;
  void prepare() noexcept;
  void look_for_sleep() noexcept;

  Device& device_;
  Clock& clock_;
  ForceLaw law_;
  TickSink sink_;
  ServoSettings settings_;
  std::int64_t due_ns_;
  std::int64_t end_ns_;
  std::int64_t asleep_ns_;  // of the clock, known so far
  std::optional<ServoEnd> end_;
};

/// Runs one force law on one device until the periods are used up, `stop` is set, or the device is
/// in fault. Leaves the device idle (or in fault) with zero force sent.
/// Real-time: safe; it is the servo thread.
THIMBLE_EXPORT ServoEnd run_servo(Device& device, Clock& clock, ForceLaw law, TickSink sink,
                                  const ServoSettings& settings,
                                  const std::atomic<bool>& stop) noexcept;

}  // namespace thimble::driver
