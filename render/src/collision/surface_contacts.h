#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>

namespace thimble::render {

/// Contacts of a convex body with the triangles of a surface at rest: as far ahead as the body can
/// come within a step, where Bullet's own algorithm finds those that it overlaps.
struct SurfaceContacts final : public btCollisionAlgorithmCreateFunc {
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* a,
                                                 const btCollisionObjectWrapper* b) override;
};

}  // namespace thimble::render
