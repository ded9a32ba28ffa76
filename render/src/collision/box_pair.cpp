#include "collision/box_pair.h"

#include <BulletCollision/CollisionDispatch/btBoxBoxDetector.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>

#include "collision/pair_contact.h"

namespace thimble::render {
namespace {

/// Moves the contacts of grown boxes to the boxes.
class MovedBack final : public btDiscreteCollisionDetectorInterface::Result {
 public:
  MovedBack(btManifoldResult& out, btScalar reach) : out_(out), reach_(reach) {}
  void setShapeIdentifiersA(int part, int index) override {
    out_.setShapeIdentifiersA(part, index);
  }
  void setShapeIdentifiersB(int part, int index) override {
    out_.setShapeIdentifiersB(part, index);
  }
  void addContactPoint(const btVector3& normal, const btVector3& on_b, btScalar depth) override {
    out_.addContactPoint(normal, on_b - reach_ / 2 * normal, depth + reach_);
  }

 private:
  btManifoldResult& out_;
  btScalar reach_;
};

btBoxShape grown(const btCollisionShape* shape, btScalar by) {
  const auto* const box = static_cast<const btBoxShape*>(shape);
  return btBoxShape(box->getHalfExtentsWithMargin() + btVector3(by, by, by));
}

class BoxPair final : public PairContact {
 public:
  using PairContact::PairContact;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo&, btManifoldResult* result) override {
    const btScalar reach = manifold_->getContactBreakingThreshold();
    const btBoxShape box_a = grown(a->getCollisionShape(), reach / 2);
    const btBoxShape box_b = grown(b->getCollisionShape(), reach / 2);
    result->setPersistentManifold(manifold_);
    btDiscreteCollisionDetectorInterface::ClosestPointInput input;
    input.m_maximumDistanceSquared = BT_LARGE_FLOAT;
    input.m_transformA = a->getWorldTransform();
    input.m_transformB = b->getWorldTransform();
    MovedBack moved(*result, reach);
    btBoxBoxDetector(&box_a, &box_b).getClosestPoints(input, moved, nullptr);
    result->refreshContactPoints();
  }
};

}  // namespace

btCollisionAlgorithm* BoxPairs::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                         const btCollisionObjectWrapper* a,
                                                         const btCollisionObjectWrapper* b) {
  return make_pair_contact<BoxPair>(info, a, b);
}

}  // namespace thimble::render
