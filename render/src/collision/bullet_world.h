#pragma once

#include <btBulletDynamicsCommon.h>

namespace thimble::render {

/// Index of a floor (btCollisionObject::setUserIndex), whose friction is that of the pair.
constexpr int kPairFriction = 1;

/// Returns how two objects rebound: the larger restitution. Real-time: safe.
btScalar pair_restitution(const btCollisionObject* a, const btCollisionObject* b) noexcept;

/// Sets the rules for pairs. They are variables of Bullet's own; all solvers of a process use the
/// same. Real-time: never from the servo thread.
void set_pair_rules();

/// Bullet's dispatcher, which finds contacts before bodies overlap: as far ahead as two bodies can
/// come within a step. So they are stopped where they touch. In Bullet's units.
class ForesightedDispatcher final : public btCollisionDispatcher {
 public:
  using btCollisionDispatcher::btCollisionDispatcher;
  /// Sets the step, s.
  void look_ahead(double step) noexcept { step_ = step; }
  btPersistentManifold* getNewManifold(const btCollisionObject* a,
                                       const btCollisionObject* b) override {
    btPersistentManifold* const manifold = btCollisionDispatcher::getNewManifold(a, b);
    set_reach(*manifold);
    return manifold;
  }
  /// Sets how far ahead the contacts of a pair are found.
  void set_reach(btPersistentManifold& manifold) const noexcept {
    btScalar reach = kLeast;
    for (const btCollisionObject* object : {manifold.getBody0(), manifold.getBody1()}) {
      btVector3 middle;
      btScalar radius = 0;
      object->getCollisionShape()->getBoundingSphere(middle, radius);
      if (object->isStaticObject()) continue;
      reach += step_ * (object->getInterpolationLinearVelocity().length() +
                        object->getInterpolationAngularVelocity().length() * radius);
    }
    manifold.setContactBreakingThreshold(reach);
  }

 private:
  static constexpr btScalar kLeast = 0.02;  // Bullet's own
  double step_ = 1e-3;
};

/// Bullet's solver, with room for the rows of later steps.
class RoomyImpulses final : public btSequentialImpulseConstraintSolver {
 public:
  /// Takes memory. Real-time: never from the servo thread.
  void reserve(int bodies, int contacts, int joints) {
    constexpr int kRowsOfJoint = 8;  // six ways, a limit and a motor
    m_tmpSolverBodyPool.reserve(bodies + 1);
    m_tmpSolverContactConstraintPool.reserve(contacts);
    m_tmpSolverContactFrictionConstraintPool.reserve(2 * contacts);
    m_tmpSolverNonContactConstraintPool.reserve(kRowsOfJoint * joints);
    m_tmpConstraintSizesPool.reserve(joints);
    m_orderTmpConstraintPool.reserve(contacts);
    m_orderFrictionConstraintPool.reserve(2 * contacts);
    m_orderNonContactConstraintPool.reserve(kRowsOfJoint * joints);
  }
};

/// Bullet's world, which reports contacts to the solver before their impulses are computed.
class ObservedWorld final : public btDiscreteDynamicsWorld {
 public:
  using btDiscreteDynamicsWorld::btDiscreteDynamicsWorld;
  /// Sets what is called.
  template <class Observer>
  void observe(Observer* observer) noexcept {
    observer_ = observer;
    call_ = [](void* who) { static_cast<Observer*>(who)->note_approaches(); };
  }

  /// Finds contacts at the present places, without a step. Real-time: as a step.
  void find_contacts() { performDiscreteCollisionDetection(); }

 protected:
  void performDiscreteCollisionDetection() override {
    auto& dispatcher = *static_cast<ForesightedDispatcher*>(getDispatcher());
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
      btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
      dispatcher.set_reach(manifold);
      // Older points of a body that rolls would push it forward.
      if (is_round(manifold)) manifold.clearManifold();
    }
    btDiscreteDynamicsWorld::performDiscreteCollisionDetection();
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
      drop_drifted(*dispatcher.getManifoldByIndexInternal(m));
    }
  }
  void solveConstraints(btContactSolverInfo& info) override {
    if (call_ != nullptr) call_(observer_);
    btDiscreteDynamicsWorld::solveConstraints(info);
  }

 private:
  // Whether the pair has a point of contact for the whole of a round body. PlaneContacts and
  // RoundContacts find new points by themselves.
  static bool is_round(const btPersistentManifold& manifold) noexcept {
    int round = 0;
    for (const btCollisionObject* object : {manifold.getBody0(), manifold.getBody1()}) {
      switch (object->getCollisionShape()->getShapeType()) {
        case STATIC_PLANE_PROXYTYPE:
          return false;
        case SPHERE_SHAPE_PROXYTYPE:
          round += 2;
          break;
        case CYLINDER_SHAPE_PROXYTYPE:
        case CAPSULE_SHAPE_PROXYTYPE:
        case CONE_SHAPE_PROXYTYPE:
          round += 1;
          break;
        default:
          break;
      }
    }
    return round >= 2;
  }
  // Removes points whose ends have moved apart along the surface. Bullet does so too, but by the
  // distance at which it finds contacts ahead.
  static void drop_drifted(btPersistentManifold& manifold) noexcept {
    constexpr btScalar kDrift = 0.02;  // Bullet's own limit
    for (int p = manifold.getNumContacts() - 1; p >= 0; --p) {
      const btManifoldPoint& point = manifold.getContactPoint(p);
      const btVector3 apart = point.getPositionWorldOnA() - point.getPositionWorldOnB();
      const btVector3 along = apart - point.m_normalWorldOnB * apart.dot(point.m_normalWorldOnB);
      if (along.length2() > kDrift * kDrift) manifold.removeContactPoint(p);
    }
  }

  void* observer_ = nullptr;
  void (*call_)(void*) = nullptr;
};

}  // namespace thimble::render
