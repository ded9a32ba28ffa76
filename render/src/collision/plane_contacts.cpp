#include "collision/plane_contacts.h"

#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include <cstddef>

#include "collision/lowest_points.h"
#include "collision/pair_contact.h"

namespace thimble::render {
namespace {

class PlaneContact final : public PairContact {
 public:
  using PairContact::PairContact;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo&, btManifoldResult* result) override {
    const bool second = b->getCollisionShape()->getShapeType() == STATIC_PLANE_PROXYTYPE;
    const btCollisionObjectWrapper& body = second ? *a : *b;
    const btCollisionObjectWrapper& ground = second ? *b : *a;
    const auto& shape = *static_cast<const btStaticPlaneShape*>(ground.getCollisionShape());
    const btTransform& at_W = body.getWorldTransform();
    const btVector3 n_W = ground.getWorldTransform().getBasis() * shape.getPlaneNormal();
    const btScalar height_W =
        shape.getPlaneConstant() + n_W.dot(ground.getWorldTransform().getOrigin());
    const Plane plane{n_W * at_W.getBasis(), height_W - n_W.dot(at_W.getOrigin())};
    LowestPoints lowest(plane, manifold_->getContactBreakingThreshold());
    lowest.choose(
        [&](const auto& visit) { visit_points(*body.getCollisionShape(), plane, visit); });

    const ContactsBefore before(*manifold_);
    result->setPersistentManifold(manifold_);
    for (std::size_t i = 0; i < lowest.count(); ++i) {
      const btScalar above = plane.above(lowest.point(i));
      const btVector3 p_W = at_W * lowest.point(i);
      if (second) {
        result->addContactPoint(n_W, p_W - above * n_W, above);
      } else {
        result->addContactPoint(-n_W, p_W, above);
      }
    }
    before.give_impulses();
    result->refreshContactPoints();
  }
};

}  // namespace

btCollisionAlgorithm* PlaneContacts::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
    const btCollisionObjectWrapper* b) {
  return make_pair_contact<PlaneContact>(info, a, b);
}

}  // namespace thimble::render
