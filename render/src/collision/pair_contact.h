#pragma once

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <new>

namespace thimble::render {

/// What the algorithms for pairs have in common: the pair's own contacts.
class PairContact : public btActivatingCollisionAlgorithm {
 public:
  /// Takes contacts of the pair, `first` being Bullet's body 0.
  PairContact(const btCollisionAlgorithmConstructionInfo& info,
              const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second)
      : btActivatingCollisionAlgorithm(info, first, second),
        manifold_(m_dispatcher->getNewManifold(first->getCollisionObject(),
                                               second->getCollisionObject())) {}
  ~PairContact() override { m_dispatcher->releaseManifold(manifold_); }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& all) override { all.push_back(manifold_); }

 protected:
  btPersistentManifold* manifold_;
};

/// Makes algorithms of one class for Bullet's dispatcher.
template <class Algorithm>
btCollisionAlgorithm* make_pair_contact(btCollisionAlgorithmConstructionInfo& info,
                                        const btCollisionObjectWrapper* a,
                                        const btCollisionObjectWrapper* b) {
  void* const memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Algorithm));
  return new (memory) Algorithm(info, a, b);
}

}  // namespace thimble::render
