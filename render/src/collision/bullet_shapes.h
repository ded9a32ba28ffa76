#pragma once

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "collision/collider.h"

namespace thimble::render {

/// Shapes of one object for Bullet, with all that they refer to.
///
/// Bullet has constants in its units of length (margins, thresholds of contact). They suit bodies
/// of about one unit [Bullet], so all lengths are multiplied by `scale`.
class BulletShapes {
 public:
  /// Makes the shapes; `scale` in units per m. A body that `moves` cannot have a half-space.
  /// Real-time: never from the servo thread.
  BulletShapes(const ColliderSet& set, double scale, bool moves);
  BulletShapes(BulletShapes&&) noexcept;
  BulletShapes& operator=(BulletShapes&&) noexcept;
  ~BulletShapes();

  /// Returns the whole; null if there is no shape.
  btCollisionShape* whole() const noexcept;
  /// Returns the place of the whole in the owner's frame, if the owner does not move; the identity
  /// for a body, which has its shape where it is.
  btTransform place() const noexcept { return place_; }
  /// Returns half the least side of the smallest shape, in Bullet's units.
  double inner_radius() const noexcept { return inner_; }
  /// Returns whether the whole is a surface of triangles that never moves.
  bool is_surface() const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  btTransform place_ = btTransform::getIdentity();
  double inner_ = 0;
};

}  // namespace thimble::render
