#pragma once

#include <Eigen/Core>
#include <atomic>

#include "bringup/bench_arm.h"
#include "bringup/estimate.h"
#include "thimble/scene/arm_file.h"

namespace thimble::bringup {

/// Data about an arm whose watchdog is to be measured.
struct WatchdogOrder {
  double named = 0;                 ///< Watchdog time in the arm file, s.
  double mass = 0;                  ///< Mass at the tip, kg.
  double coulomb = 0;               ///< Dry friction per axis, N.
  double delay = 0;                 ///< Delay from a force to the motion that the host sees, s.
  scene::WorkspaceBox workspace{};  ///< Region in which the arm may be pushed.
  double max_force = 1;             ///< Max. requested force, N.
  /// Unit vector of the push in the world (`push_direction`).
  Eigen::Vector3d direction_W{0, 1, 0};
};

/// End of a search for the watchdog's time.
enum class WatchdogEnd {
  kSeen,         ///< The motors switched off by themselves.
  kTooLong,      ///< A free tip would move too far in that time, so no force was applied.
  kNoRoom,       ///< The workspace ends within that distance, so no force was applied.
  kTooMuch,      ///< Dry friction needs more force than is allowed, so no force was applied.
  kAnswersOnly,  ///< The arm sends only when asked, so its motion in silence is not visible.
  kHeld,         ///< The tip did not move under the force.
  kLetGo,        ///< The tip moved so far that it was released before the file's time was over.
  kStillOn,      ///< The tip moved so far that it was released, later than the file's time.
  kStopped,      ///< A fault, a stop, or a tip outside of the workspace ended it.
};

/// Result of one push.
struct WatchdogPush {
  WatchdogEnd end = WatchdogEnd::kStopped;
  double time = 0;   ///< Time from the last message to the end of the force, s.
  double way = 0;    ///< Distance that the tip moved, m.
  double force = 0;  ///< Force on the tip, N.
};

/// Max. distance of a free tip while the watchdog is awaited, m.
inline constexpr double kWatchdogWayMax = 0.015;

/// Pushes a free tip with slightly more than its dry friction along `direction_W`, forwards or
/// backwards (`sign` 1 or -1), then stops sending. The tip's speed is greatest when the force ends.
/// A tip that has moved 15 mm, or left the workspace, is released before that by a message of zero
/// force. The device must be active, its soft start over; it is idle afterwards. Real-time: never
/// from the servo thread.
WatchdogPush observe_watchdog(BenchArm& bench, const WatchdogOrder& order, double sign,
                              const std::atomic<bool>& stop);

/// The watchdog's time from several pushes.
struct WatchdogTime {
  WatchdogPush last;  ///< Last push; if its end is not kSeen, there is no time.
  Estimate time;      ///< s
  int pushes = 0;     ///< Number of pushes that showed it.

  /// Returns whether the time is known.
  bool known() const { return last.end == WatchdogEnd::kSeen && pushes > 1; }
};

/// Measures the watchdog's time of an idle arm by a few pushes in both directions. The interval is
/// that of Student's distribution. Real-time: never from the servo thread.
WatchdogTime watchdog_time(BenchArm& bench, const WatchdogOrder& order, double soft_start,
                           const std::atomic<bool>& stop);

}  // namespace thimble::bringup
