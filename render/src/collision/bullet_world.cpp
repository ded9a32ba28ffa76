#include "collision/bullet_world.h"

#include <BulletCollision/CollisionDispatch/btInternalEdgeUtility.h>

#include <algorithm>
#include <cmath>

namespace thimble::render {
namespace {

btScalar pair_friction(const btCollisionObject* a, const btCollisionObject* b) {
  for (const btCollisionObject* one : {a, b}) {
    if (one->getUserIndex() == kPairFriction) return one->getFriction();
  }
  return std::sqrt(a->getFriction() * b->getFriction());
}

// Moves the contact of a ball to where the normal through its centre meets it, so that it does not
// turn the ball.
void centre_on_ball(btManifoldPoint& point, const btCollisionObjectWrapper& ball,
                    const btCollisionObjectWrapper& surface) {
  const btVector3& n = point.m_normalWorldOnB;
  const btVector3 centre = ball.getWorldTransform().getOrigin();
  const btScalar radius = static_cast<const btSphereShape*>(ball.getCollisionShape())->getRadius();
  const btScalar above = n.dot(centre - point.m_positionWorldOnB);
  point.m_positionWorldOnA = centre - radius * n;
  point.m_positionWorldOnB = centre - above * n;
  point.m_distance1 = above - radius;
  point.m_localPointA = ball.getWorldTransform().invXform(point.m_positionWorldOnA);
  point.m_localPointB = surface.getWorldTransform().invXform(point.m_positionWorldOnB);
}

// At an edge between two triangles of a flat surface, the normal of the surface counts.
bool adjust_edges(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                  const btCollisionObjectWrapper* b, int part, int index) {
  if ((b->getCollisionObject()->getCollisionFlags() &
       btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK) != 0) {
    const btVector3 on_surface = point.m_positionWorldOnB;
    btAdjustInternalEdgeContacts(point, b, a, part, index);
    if (a->getCollisionShape()->getShapeType() == SPHERE_SHAPE_PROXYTYPE) {
      point.m_positionWorldOnB = on_surface;
      centre_on_ball(point, *a, *b);
    }
  }
  return true;
}

}  // namespace

btScalar pair_restitution(const btCollisionObject* a, const btCollisionObject* b) noexcept {
  return std::max(a->getRestitution(), b->getRestitution());
}

void set_pair_rules() {
  static const bool done = [] {
    gCalculateCombinedFrictionCallback = &pair_friction;
    gCalculateCombinedRestitutionCallback = &pair_restitution;
    gContactAddedCallback = &adjust_edges;
    return true;
  }();
  static_cast<void>(done);
}

}  // namespace thimble::render
