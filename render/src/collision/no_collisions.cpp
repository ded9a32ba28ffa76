// Replaces collisions and joints in a build without Bullet.
#include "collision/collide_objects.h"

namespace thimble::render {

driver::Result<CollidingTouches> collide_objects(std::vector<CollidingObject>,
                                                 const std::vector<ObjectJoint>&,
                                                 const CollisionQuality&, std::size_t) {
  return driver::Error{
      "This build has no bodies that meet and no joints. Set collision: {shape: none} for all "
      "objects that move and remove joints, or install libbullet-dev and configure with -D "
      "THIMBLE_BULLET=ON."};
}

}  // namespace thimble::render
