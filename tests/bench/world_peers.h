#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace thimble::bench {

/// A ball or an axis-aligned cube.
struct WorldItem {
  Eigen::Vector3d p_W{0, 0, 0};  ///< Centre, m.
  double radius = 0;             ///< Radius of the ball, half side of the cube, m.
  bool cube = false;             ///< True for a cube.
};

/// Another library that finds what the path of a tip meets among many objects.
class WorldPeer {
 public:
  virtual ~WorldPeer() = default;

  /// Returns the name of the library and of the function measured.
  virtual std::string name() const = 0;

  /// Returns the position along the segment (0 to 1) where the first object is hit. A library that
  /// answers without a place returns 0. NaN: nothing is hit.
  virtual double first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& to) = 0;

  /// Places all objects at their first places moved by `d_W` (m).
  virtual void move_all(const Eigen::Vector3d& d_W) = 0;
};

/// Bullet's world of collision objects over btDbvtBroadphase, in double precision: `rayTest`, once
/// with the exact shapes and once with the boxes of the broad phase.
std::unique_ptr<WorldPeer> make_bullet_world(std::span<const WorldItem> items, bool exact);

/// FCL's DynamicAABBTreeCollisionManager, which has no ray: contact with a capsule along the
/// segment.
std::unique_ptr<WorldPeer> make_fcl_world(std::span<const WorldItem> items);

}  // namespace thimble::bench
