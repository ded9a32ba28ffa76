#pragma once

#include <string>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {

/// How many times the reach of the arm a mesh may be large whose unit is not known, because neither
/// its file nor the scene (size, scale) names one [chosen: a part of 5 mm that is read in m exceeds
/// it for every shipped arm].
inline constexpr double kReachesMax = 20;

/// The same of any mesh. What is larger cannot be felt as a shape.
inline constexpr double kStatedReachesMax = 100;

/// From how many times on it is reported where the unit is not known.
inline constexpr double kReachesReported = 5;

/// What is known of the size of a mesh in a scene.
struct ObjectSize {
  double side = 0;       ///< The largest side of its box in the world, m.
  std::string kind;      ///< Its format, "STL"; for messages.
  bool has_unit = true;  ///< Whether its file names a unit.
};

/// Returns the reach of the arms of a scene: the largest side of their workspaces, m; 0 if no arm
/// has one. Real-time: never from the servo thread.
double reach_of(const Scene& scene);

/// Returns what to do about a format without a unit: "STL names no unit: set scale: 0.001 ...".
THIMBLE_EXPORT std::string unit_advice(const std::string& kind);

/// Returns a sentence about an object that is far larger than the `reach` of the arm (m), empty if
/// it is not or if the reach is 0. The error is that of an object that is too large: its file, how
/// large it is, and what to set. Real-time: never from the servo thread.
driver::Result<std::string> judge_size(const SceneObject& object, const ObjectSize& size,
                                       double reach);

}  // namespace thimble::scene
