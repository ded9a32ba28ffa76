#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>

namespace thimble::render {

/// Contacts of a cylinder, capsule or cone with a box or hull: all points of its lowest edge over
/// the other's face at once, new in each step. Bullet's own algorithm finds them one by one, and
/// keeps old ones, which push a body that rolls.
struct RoundContacts final : public btCollisionAlgorithmCreateFunc {
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* a,
                                                 const btCollisionObjectWrapper* b) override;
};

}  // namespace thimble::render
