#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "thimble/driver/fault.h"
#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// What can change a force, or disturb the loop, for some ticks: logged when it begins and ends.
enum class Activity : std::uint8_t {
  kSoftStart,    ///< The gate's limit opens (GateCounters::soft_started).
  kForceCut,     ///< The gate cuts to the arm's limit (limited).
  kRiseCut,      ///< The gate holds the rise back (rise_limited).
  kDamped,       ///< The gate's passivity stage adds damping (damped).
  kBounded,      ///< The gate's energy bound cuts (bounded).
  kHeat,         ///< The force is lowered because a motor is hot (HeatGuard::lowered).
  kStall,        ///< The loop stood still (stalls).
  kMissedTicks,  ///< Periods of the loop were skipped.
  kRejected,     ///< Reports came that the protocol does not know (WireCounters::rejected).
  kJumped,       ///< Reports were dropped for a jump that no hand makes (jumped).
  kRefused,      ///< The arm took no messages (refused).
  kPower,        ///< The gate lowers the force for its mean power (power_limited).
  kCalmed,       ///< The gate lowers a program's force that oscillated (calmed).
  kWall,         ///< A wall of the workspace pushes (WallCounters::pushed).
};
inline constexpr std::size_t kActivities = 14;

/// Returns whether an activity is a stage that changes forces.
constexpr bool changes_force(Activity activity) noexcept {
  return activity <= Activity::kHeat || activity >= Activity::kPower;
}

/// How often each activity occurred since the device was opened.
using ActivityCounts = std::array<std::uint64_t, kActivities>;

/// What an event is.
enum class EventKind : std::uint8_t {
  kActivated,      ///< Forces are let through from this tick on.
  kDeactivated,    ///< Zero force from this tick on, without a fault.
  kFault,          ///< `fault` switched the force off.
  kWireTaken,      ///< A new wire to a lost arm was taken.
  kActivityBegan,  ///< `activity` occurred first after a quiet time.
  kActivityEnded,  ///< `activity` has been quiet; it occurred `count` times in `lasted_ns`.
  kTouchBegan,     ///< The tip touches `object`.
  kTouchEnded,     ///< The tip touches nothing any more.
  /// The stage `activity` has changed the force by more than a tenth for 0.2 s, now by `count`
  /// percent of what was wanted; once in a run for each stage.
  kForceChanged,
  kWaiting,      ///< Zero force until the enabling input is held.
  kLinkChanged,  ///< The link came into the state `link`, which is not what `fault` says.
};

/// Something that happened in a run, as plain numbers for the way out of the servo.
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
  /// Force of the walls of the workspace, N in the world: where kWall began, or the strongest
  /// until it ended.
  std::array<double, 3> f_wall_W{};

  bool operator==(const TickEvent&) const = default;
};

}  // namespace thimble::session
