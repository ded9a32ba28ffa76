#include "collision/surface_contacts.h"

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>

#include "collision/pair_contact.h"

namespace thimble::render {
namespace {

/// One body and one surface in one step: lets the body meet each triangle near it.
class Triangles final : public btTriangleCallback {
 public:
  Triangles(const btCollisionObjectWrapper& body, const btCollisionObjectWrapper& surface,
            btPersistentManifold& manifold, btDispatcher& dispatcher, const btDispatcherInfo& info,
            btManifoldResult& result)
      : body_(body),
        surface_(surface),
        manifold_(manifold),
        dispatcher_(dispatcher),
        info_(info),
        result_(result) {}

  void processTriangle(btVector3* corners, int part, int index) override {
    btTriangleShape triangle(corners[0], corners[1], corners[2]);
    triangle.setMargin(surface_.getCollisionShape()->getMargin());
    const btCollisionObjectWrapper wrapped(&surface_, &triangle, surface_.getCollisionObject(),
                                           surface_.getWorldTransform(), part, index);
    btCollisionAlgorithm* const pair =
        dispatcher_.findAlgorithm(&body_, &wrapped, &manifold_, BT_CONTACT_POINT_ALGORITHMS);
    if (pair == nullptr) return;
    if (result_.getBody0Internal() == surface_.getCollisionObject()) {
      const btCollisionObjectWrapper* const before = result_.getBody0Wrap();
      result_.setBody0Wrap(&wrapped);
      result_.setShapeIdentifiersA(part, index);
      pair->processCollision(&body_, &wrapped, info_, &result_);
      result_.setBody0Wrap(before);
    } else {
      const btCollisionObjectWrapper* const before = result_.getBody1Wrap();
      result_.setBody1Wrap(&wrapped);
      result_.setShapeIdentifiersB(part, index);
      pair->processCollision(&body_, &wrapped, info_, &result_);
      result_.setBody1Wrap(before);
    }
    pair->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(pair);
  }

 private:
  const btCollisionObjectWrapper& body_;
  const btCollisionObjectWrapper& surface_;
  btPersistentManifold& manifold_;
  btDispatcher& dispatcher_;
  const btDispatcherInfo& info_;
  btManifoldResult& result_;
};

class SurfaceContact final : public PairContact {
 public:
  // The surface is second, as Bullet's rules for edges expect.
  SurfaceContact(const btCollisionAlgorithmConstructionInfo& info,
                 const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b)
      : PairContact(info, a->getCollisionShape()->isConvex() ? a : b,
                    a->getCollisionShape()->isConvex() ? b : a) {}

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* result) override {
    const bool second = !b->getCollisionShape()->isConvex();
    const btCollisionObjectWrapper& body = second ? *a : *b;
    const btCollisionObjectWrapper& surface = second ? *b : *a;
    const auto& triangles = *static_cast<const btConcaveShape*>(surface.getCollisionShape());
    result->setPersistentManifold(manifold_);
    const btTransform in_surface =
        surface.getWorldTransform().inverseTimes(body.getWorldTransform());
    btVector3 low, high;
    body.getCollisionShape()->getAabb(in_surface, low, high);
    const btScalar reach = manifold_->getContactBreakingThreshold() + triangles.getMargin();
    const btVector3 more(reach, reach, reach);
    Triangles meet(body, surface, *manifold_, *m_dispatcher, info, *result);
    triangles.processAllTriangles(&meet, low - more, high + more);
    result->refreshContactPoints();
  }
};

}  // namespace

btCollisionAlgorithm* SurfaceContacts::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
    const btCollisionObjectWrapper* b) {
  return make_pair_contact<SurfaceContact>(info, a, b);
}

}  // namespace thimble::render
