#pragma once

#include <atomic>

#include "bringup/bench_arm.h"
#include "bringup/estimate.h"
#include "thimble/scene/arm_file.h"

namespace thimble::bringup {

/// What is known of an arm whose watchdog is to be seen.
struct WatchdogOrder {
  double named = 0;                 ///< The watchdog's time by the arm file, s.
  double mass = 0;                  ///< At the tip, kg.
  double coulomb = 0;               ///< Dry friction per axis, N.
  double delay = 0;                 ///< From a force to the motion that the host sees, s.
  scene::WorkspaceBox workspace{};  ///< Outside of it nothing is pushed.
  double force_most = 1;            ///< The most that may be asked for, N.
};

/// How a search for the watchdog's time ended.
enum class WatchdogEnd {
  kSeen,         ///< The motors went off by themselves.
  kTooLong,      ///< A free tip would go too far in that time, so nothing was pushed.
  kNoRoom,       ///< The workspace ends within that way, so nothing was pushed.
  kTooMuch,      ///< Its dry friction needs more force than is allowed, so nothing was pushed.
  kAnswersOnly,  ///< The arm speaks only when spoken to, so nobody sees what it does in silence.
  kHeld,         ///< The tip did not move under the push.
  kLetGo,        ///< The tip went so far that it was let go before the file's time was over.
  kStillOn,      ///< The tip went so far that it was let go, later than the file's time.
  kStopped,      ///< A fault, a stop or a tip that left the workspace ended it.
};

/// What was seen of a watchdog.
struct WatchdogSeen {
  WatchdogEnd end = WatchdogEnd::kStopped;
  double time = 0;   ///< From the last message to the end of the force, s.
  double way = 0;    ///< That the tip went, m.
  double force = 0;  ///< That pushed it, N.
};

/// How far a free tip may go while its watchdog is waited for, m.
inline constexpr double kWatchdogWayMost = 0.015;

/// Pushes a free tip a little above its dry friction along y of the world (nothing weighs there),
/// `sign` 1 or -1, then sends nothing any more: its speed is greatest when the force goes off. A
/// tip that has gone 15 mm, or left the workspace, is let go by a message of zero force before
/// that. The device must be active, its soft start over; it is idle afterwards. Real-time: never
/// from the servo thread.
WatchdogSeen see_watchdog(BenchArm& bench, const WatchdogOrder& order, double sign,
                          const std::atomic<bool>& stop);

/// The watchdog's time as several pushes show it.
struct WatchdogTime {
  WatchdogSeen last;  ///< The last push; if it was not kSeen, there is no time.
  Estimate time;      ///< s
  int pushes = 0;     ///< That showed it.

  /// Returns whether the time is known.
  bool known() const { return last.end == WatchdogEnd::kSeen && pushes > 1; }
};

/// Measures the watchdog's time of an idle arm by a few pushes to and fro. The interval is that of
/// Student's distribution. Real-time: never from the servo thread.
WatchdogTime watchdog_time(BenchArm& bench, const WatchdogOrder& order, double soft_start,
                           const std::atomic<bool>& stop);

}  // namespace thimble::bringup
