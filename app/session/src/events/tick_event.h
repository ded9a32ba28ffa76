#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "thimble/driver/fault.h"
#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// Activity that can change a force or disturb the loop for some ticks; logged when it begins and
/// ends.
enum class Activity : std::uint8_t {
  kSoftStart,    ///< The soft start of the gate is opening its limit (GateCounters::soft_started).
  kForceCut,     ///< The gate limits the force to the arm's limit (limited).
  kRiseCut,      ///< The gate limits the rise (rise_limited).
  kDamped,       ///< The gate's passivity stage adds damping (damped).
  kBounded,      ///< The gate's energy bound limits the force (bounded).
  kHeat,         ///< The force is reduced because a motor is hot (HeatGuard::lowered).
  kStall,        ///< The loop was blocked (stalls).
  kMissedTicks,  ///< Periods of the loop were skipped.
  kRejected,     ///< Invalid reports arrived (WireCounters::rejected).
  kJumped,       ///< Reports were dropped for a jump that no hand makes (jumped).
  kRefused,      ///< The arm accepted no messages (refused).
  kPower,        ///< The gate reduces the force because of its mean power (power_limited).
  kCalmed,       ///< The gate reduces a program's force that oscillated (calmed).
  kWall,         ///< A wall of the workspace pushes (WallCounters::pushed).
};
inline constexpr std::size_t kActivities = 14;

/// Returns whether an activity changes forces.
constexpr bool changes_force(Activity activity) noexcept {
  return activity <= Activity::kHeat || activity >= Activity::kPower;
}

/// Number of occurrences of each activity since the device was opened.
using ActivityCounts = std::array<std::uint64_t, kActivities>;

/// Kind of an event.
enum class EventKind : std::uint8_t {
  kActivated,      ///< Forces are enabled from this tick on.
  kDeactivated,    ///< Zero force is sent from this tick on, without a fault.
  kFault,          ///< `fault` switched the force off.
  kLinkReplaced,   ///< A new link to a lost arm was taken.
  kActivityBegan,  ///< `activity` occurred for the first time after a pause.
  kActivityEnded,  ///< `activity` has ended; it occurred `count` times in `lasted_ns`.
  kTouchBegan,     ///< The tip touches `object`.
  kTouchEnded,     ///< The tip no longer touches an object.
  /// The stage `activity` has changed the force by more than a tenth for 0.2 s, now by `count`
  /// percent of the requested force. Reported once per run and stage.
  kForceChanged,
  kWaiting,      ///< Zero force is sent until the enabling input is held.
  kLinkChanged,  ///< The link changed to the state `link`, which `fault` does not imply.
};

/// Event of a run as plain numbers, passed out of the servo thread.
struct TickEvent {
  std::uint64_t tick = 0;    ///< TickRecord::tick
  std::int64_t time_ns = 0;  ///< TickRecord::time_ns
  std::uint64_t count = 0;
  std::int64_t lasted_ns = 0;
  EventKind kind = EventKind::kActivated;
  Activity activity = Activity::kSoftStart;
  driver::Fault fault = driver::Fault::kNone;
  driver::LinkState link = driver::LinkState::kConnected;
  std::int16_t object = -1;
  /// Force of the workspace walls, N in the world: at the start of kWall, or the largest until its
  /// end.
  std::array<double, 3> f_wall_W{};

  bool operator==(const TickEvent&) const = default;
};

}  // namespace thimble::session
