#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "recording/trajectory_file.h"
#include "thimble/driver/export.h"
#include "thimble/driver/tick_record.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Comparison of the forces of a scene with those recorded along a trajectory, as Ruffaldi and
/// others evaluate renderers (Haptics Symposium 2006).
struct TrajectoryComparison {
  std::size_t ticks = 0;
  std::size_t touching = 0;  ///< Number of ticks with contact in the scene.
  double force_rms = 0;      ///< Root mean square of the computed forces, N.
  double recorded_rms = 0;   ///< Root mean square of the recorded forces, N.
  double error_rms = 0;      ///< Root mean square of the difference, N.
  /// 99th percentile of the angle between the forces in ticks where both exceed kPress, rad.
  double direction_p99 = 0;
  std::size_t directions = 0;  ///< Number of ticks in which both forces exceed kPress.
  /// Number of ticks in which one force exceeds kPress and the other is zero.
  std::size_t contact_disagrees = 0;
  /// Force below which a direction is not meaningful, N. [chosen]
  static constexpr double kPress = 0.05;
};

/// Moves a probe along a trajectory through a scene, at the given rate (Hz) and in virtual time.
/// Between the points it moves in a straight line; its velocity is the displacement in the last
/// tick over the period. `sink` receives each tick. Precondition: the trajectory has two points.
/// Real-time: never from the servo thread.
TrajectoryComparison replay_trajectory(
    const std::vector<TrajectoryPoint>& trajectory_W, double rate, scene::SceneObjects& objects,
    const std::function<void(const driver::TickRecord&)>& sink = {});

/// Result of the replay of a trajectory.
struct TrajectoryReplay {
  Recording felt;  ///< Ticks with the forces of the scene.
  TrajectoryComparison compared;
};

/// Moves a probe along a trajectory through the scene of a file. `frame` as below. Precondition:
/// the trajectory has two points and lasts at most one day. The error says how to fix the problem.
/// Real-time: never from the servo thread.
driver::Result<TrajectoryReplay> touch_along(std::vector<TrajectoryPoint> trajectory,
                                             const std::string& frame,
                                             const std::filesystem::path& scene_file);

/// Reads a trajectory file and moves its probe through a scene. `frame`: the object whose mesh file
/// has the trajectory's frame and unit; "world" or empty: the world's frame. The error says how to
/// fix the problem. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<TrajectoryReplay> replay_trajectory_file(
    const std::filesystem::path& file, TrajectoryForm form, const std::string& frame,
    const std::filesystem::path& scene_file);

}  // namespace thimble::session
