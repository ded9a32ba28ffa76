#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::scene {

/// One station of the hand's path: a free point, or a point on an object's surface.
struct HandWaypoint {
  double time = 0;                ///< s
  std::optional<std::string> on;  ///< Object that is touched; empty for a free point.
  Eigen::Vector3d p_W{0, 0, 0};   ///< The free point, or where near the surface to look for one, m.
  double press = 0;               ///< How far below the surface the hand wants to be, m.
  bool stop = false;              ///< True if the hand shall come to rest here.

  /// Returns whether two stations are the same.
  bool operator==(const HandWaypoint&) const = default;
};

/// Where the hand wants to be over time: seconds and points in the world (m).
using HandRoute = std::vector<std::pair<double, Eigen::Vector3d>>;

/// One object that the hand may follow, kept by the caller.
struct NamedMesh {
  std::string name;                              ///< As in the scene.
  const render::TriangleMesh* mesh_W = nullptr;  ///< In the world, m.
};

/// Returns the hand's path through its stations, one point every 2 ms or so.
///
/// Between two stations on the same object the hand follows the surface: points on the path between
/// are moved to the closest surface point and pressed in along its smooth normal. Where that jumps,
/// because the straight path leads through the object's middle, the hand takes the nearly shortest
/// path over the surface, and where the surface does not hang together, leaves it and comes down
/// beside the goal; it rests at both ends then. Every other stretch is a straight line. The path
/// over the surface is averaged over 60 ms, as by a hand. Position, speed and acceleration are
/// continuous in time before the move to the surface; the hand rests where the kind of stretch
/// changes, at the ends, and where `stop` is set.
///
/// Fails, naming the times, if times do not grow, if a station is on an object that is not among
/// `objects`, or if no path outside leads from one part of an object to another.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<HandRoute> plan_hand(const std::vector<HandWaypoint>& waypoints,
                                                   const std::vector<NamedMesh>& objects);

}  // namespace thimble::scene
