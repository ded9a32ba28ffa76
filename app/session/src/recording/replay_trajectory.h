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

/// How the forces of a scene compare with those that a trajectory was recorded with, as
/// Ruffaldi and others evaluate renderers (Haptics Symposium 2006).
struct TrajectoryComparison {
  std::size_t ticks = 0;
  std::size_t touching = 0;    ///< Ticks in which the scene is touched.
  double force_rms = 0;        ///< Of what the scene answered, N.
  double recorded_rms = 0;     ///< Of what was recorded, N.
  double error_rms = 0;        ///< Of their difference, N.
  double direction_p99 = 0;    ///< rad; 99 of 100 ticks in which both press are better.
  std::size_t directions = 0;  ///< Ticks in which both press by more than kPress.
  std::size_t contact_disagrees =
      0;  ///< Ticks in which one presses by more than kPress, the other not at all.
  static constexpr double kPress = 0.05;  ///< N; below that a direction says nothing. [chosen]
};

/// Lets a probe that went along a trajectory touch a scene, at the scene's rate (Hz) and in virtual
/// time: between the points it goes straight, its velocity is that of the last tick's way. `sink`
/// is handed each tick. Precondition: the trajectory has two points. Real-time: never from the
/// servo thread.
TrajectoryComparison replay_trajectory(
    const std::vector<TrajectoryPoint>& trajectory_W, double rate, scene::SceneObjects& objects,
    const std::function<void(const driver::TickRecord&)>& sink = {});

/// A trajectory that touched a scene.
struct TrajectoryReplay {
  Recording felt;  ///< What the scene answered.
  TrajectoryComparison compared;
};

/// Lets a probe that went along a trajectory touch the scene of a file. `frame` as below.
/// Precondition: the trajectory has two points and lasts for a day at most. The error says what to
/// mend. Real-time: never from the servo thread.
driver::Result<TrajectoryReplay> touch_along(std::vector<TrajectoryPoint> trajectory,
                                             const std::string& frame,
                                             const std::filesystem::path& scene_file);

/// Reads a trajectory file and lets its probe touch a scene. `frame`: the object whose mesh file
/// has the trajectory's frame and unit; "world" or empty: it is told in the world. The error says
/// what to mend. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<TrajectoryReplay> replay_trajectory_file(
    const std::filesystem::path& file, TrajectoryForm form, const std::string& frame,
    const std::filesystem::path& scene_file);

}  // namespace thimble::session
