#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::scene {

/// Waypoint of the hand's path: a free point, or a point on the surface of an object.
struct HandWaypoint {
  double time = 0;                ///< Time, s.
  std::optional<std::string> on;  ///< Object to touch; empty for a free point.
  /// Free point, or the point near which the closest point of the surface is used, in the world, m.
  Eigen::Vector3d p_W{0, 0, 0};
  /// Depth of the hand's target below the surface, m; less the radius of a tip that is a ball.
  double press = 0;
  bool stop = false;  ///< True if the hand stops here.

  /// Returns whether two waypoints are equal.
  bool operator==(const HandWaypoint&) const = default;
};

/// Buttons that a simulated hand holds from a time until the next step.
struct ButtonStep {
  double time = 0;            ///< Time, s; 0: the run begins.
  std::uint16_t buttons = 0;  ///< One bit each; bit 0 is the arm's first button.

  /// Returns whether two steps are equal.
  bool operator==(const ButtonStep&) const = default;
};

/// Target of the hand over time: seconds and points in the world (m).
using HandRoute = std::vector<std::pair<double, Eigen::Vector3d>>;

/// Mesh that the hand may follow, with its name. The caller owns the mesh.
struct NamedMesh {
  std::string name;                              ///< Name in the scene.
  const render::TriangleMesh* mesh_W = nullptr;  ///< Mesh in the world, m.
};

/// Returns the hand's path through its waypoints, with one point about every 2 ms.
///
/// Between two waypoints on the same object the hand follows the surface. Each point of the
/// straight path is moved to the closest surface point and pressed in along its smooth normal. If
/// the closest point jumps, because the straight path crosses the middle of the object, the hand
/// takes a nearly shortest path over the surface. If the surface parts are not connected, the hand
/// lifts off and comes down next to the goal. In both cases it rests at both ends. Every other
/// segment is a straight line. The path over the surface is averaged over 60 ms, as a person's
/// movement is. Before the projection to the surface, position, velocity and acceleration are
/// continuous in time. The hand rests where the kind of segment changes, at the ends, and at
/// waypoints with `stop`.
///
/// Fails if times do not increase or a waypoint names an object that is not in `objects`. Also
/// fails if no path outside of an object connects two of its parts. The error names the times.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<HandRoute> plan_hand(const std::vector<HandWaypoint>& waypoints,
                                                   const std::vector<NamedMesh>& objects);

}  // namespace thimble::scene
