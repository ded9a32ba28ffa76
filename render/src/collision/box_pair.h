#pragma once

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>

namespace thimble::render {

/// Makes the contacts of two boxes for Bullet: up to four corners of their common face, found
/// before they overlap. Bullet's own algorithm finds none before. So both boxes are grown by half
/// of the distance within which contacts are wanted, and the contacts moved back.
class BoxPairs final : public btCollisionAlgorithmCreateFunc {
 public:
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* a,
                                                 const btCollisionObjectWrapper* b) override;
};

}  // namespace thimble::render
