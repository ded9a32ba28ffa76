#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>

namespace thimble::render {

/// Contacts of a convex body with a half-space (btStaticPlaneShape): all of its lowest points at
/// once, new in each step. Bullet's own algorithm finds them one by one, and keeps old ones, which
/// push a body that rolls. An impulse is kept for the next point at the same place.
struct PlaneContacts final : public btCollisionAlgorithmCreateFunc {
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* a,
                                                 const btCollisionObjectWrapper* b) override;
};

}  // namespace thimble::render
