#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btInternalEdgeUtility.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "collision/box_pair.h"
#include "collision/bullet_shapes.h"
#include "collision/bullet_units.h"
#include "collision/collision_solver.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// A floor's friction is that of the pair. It is stored in the floor itself, marked by this index.
constexpr int kPairFriction = 1;

btScalar pair_friction(const btCollisionObject* a, const btCollisionObject* b) {
  for (const btCollisionObject* one : {a, b}) {
    if (one->getUserIndex() == kPairFriction) return one->getFriction();
  }
  return std::sqrt(a->getFriction() * b->getFriction());
}

btScalar pair_restitution(const btCollisionObject* a, const btCollisionObject* b) {
  return std::max(a->getRestitution(), b->getRestitution());
}

// At an edge between two triangles of a flat surface, the normal of the surface counts.
bool adjust_edges(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                  const btCollisionObjectWrapper* b, int part, int index) {
  if ((b->getCollisionObject()->getCollisionFlags() &
       btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK) != 0) {
    btAdjustInternalEdgeContacts(point, b, a, part, index);
  }
  return true;
}

// The rules for pairs are variables of Bullet's own; all solvers of a process use the same.
void set_pair_rules() {
  static const bool done = [] {
    gCalculateCombinedFrictionCallback = &pair_friction;
    gCalculateCombinedRestitutionCallback = &pair_restitution;
    gContactAddedCallback = &adjust_edges;
    return true;
  }();
  static_cast<void>(done);
}

/// A contact that rebounds, in Bullet's units.
struct Rebound {
  btRigidBody* a = nullptr;
  btRigidBody* b = nullptr;
  const btManifoldPoint* point = nullptr;
  btVector3 normal;        // from b to a
  btVector3 arm_a, arm_b;  // from the centres to the contact
  btScalar wanted = 0;     // speed apart after the step
  btScalar impulse = 0;
};

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

 protected:
  void performDiscreteCollisionDetection() override {
    auto& dispatcher = *static_cast<ForesightedDispatcher*>(getDispatcher());
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
      btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
      dispatcher.set_reach(manifold);
      // A sphere has one point of contact with each convex body. Older ones would have another
      // normal and push it forward.
      if (has_sphere(manifold)) manifold.clearManifold();
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
  static bool has_sphere(const btPersistentManifold& manifold) noexcept {
    return manifold.getBody0()->getCollisionShape()->getShapeType() == SPHERE_SHAPE_PROXYTYPE ||
           manifold.getBody1()->getCollisionShape()->getShapeType() == SPHERE_SHAPE_PROXYTYPE;
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

class BulletSolver final : public CollisionSolver {
 public:
  BulletSolver(const SolverPlan& plan, std::span<const SolverState> first);
  ~BulletSolver() override;

  void step(std::span<SolverState> bodies, double step) noexcept override;
  const SolverCounters& counters() const noexcept override { return counters_; }
  /// Called by the world between finding contacts and computing their impulses.
  void note_approaches() noexcept;

 private:
  void add_bodies(const SolverPlan& plan, std::span<const SolverState> first);
  btRigidBody* add_fixed(const ColliderSet& set);
  void add_floor(const Floor& floor);
  void add_joint(const SolverJoint& joint, std::span<const SolverState> first);
  void add_constraint(std::unique_ptr<btTypedConstraint> constraint);
  void rebound(std::span<const SolverState> bodies) noexcept;
  void push_apart(double share) noexcept;
  double kinetic_energy() const noexcept;
  void mark_met(std::span<SolverState> bodies) noexcept;
  btVector3 length(const Vector3d& v) const noexcept { return to_bullet(Vector3d(scale_ * v)); }

  struct Own {
    std::unique_ptr<btRigidBody> body;
    bool jointed = false;
  };
  struct FloorBody {
    Floor floor;
    btRigidBody* body = nullptr;  // one of `fixed_`
  };

  double scale_ = 1;  // Bullet's units per m
  std::size_t substeps_ = 1;
  double part_ = 1e-3;  // s, of a substep
  double before_ = 0;   // energy of motion before a substep, in Bullet's units
  std::vector<BulletShapes> shapes_;
  btDefaultCollisionConfiguration configuration_;
  BoxPairs box_pairs_;
  btGjkEpaPenetrationDepthSolver penetration_;
  btConvexConvexAlgorithm::CreateFunc sphere_pairs_{&penetration_};
  ForesightedDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver impulses_;
  ObservedWorld world_{&dispatcher_, &broadphase_, &impulses_, &configuration_};
  std::vector<Own> own_;
  std::vector<std::unique_ptr<btRigidBody>> fixed_;
  std::vector<FloorBody> floors_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
  std::unique_ptr<btRigidBody> anchor_;  // the world, for joints
  SolverCounters counters_;
  std::vector<Rebound> rebounds_;
  std::vector<std::pair<btVector3, btVector3>> plain_;  // velocities without rebounds
};

/// Returns the size of a typical body: the median radius of gyration, m.
double typical_size(const SolverPlan& plan) {
  std::vector<double> sizes;
  for (const SolverBody& body : plan.bodies) {
    sizes.push_back(std::sqrt(body.inertia.sum() / body.mass));
  }
  if (sizes.empty()) return 1;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

BulletSolver::BulletSolver(const SolverPlan& plan, std::span<const SolverState> first)
    : scale_(1 / typical_size(plan)),
      substeps_(std::max<std::size_t>(plan.quality.substeps, 1)),
      part_(plan.step / static_cast<double>(substeps_)) {
  set_pair_rules();
  btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
  // Round bodies get up to three points in one step [Bullet], spheres only one.
  configuration_.setConvexConvexMultipointIterations(3, 3);
  world_.setGravity({0, 0, 0});
  world_.observe(this);
  world_.setForceUpdateAllAabbs(false);
  // Bullet's own algorithms for two boxes and two spheres find no contact ahead.
  dispatcher_.registerCollisionCreateFunc(BOX_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE, &box_pairs_);
  for (int other = 0; other < CONCAVE_SHAPES_START_HERE; ++other) {
    dispatcher_.registerCollisionCreateFunc(SPHERE_SHAPE_PROXYTYPE, other, &sphere_pairs_);
    dispatcher_.registerCollisionCreateFunc(other, SPHERE_SHAPE_PROXYTYPE, &sphere_pairs_);
  }
  dispatcher_.look_ahead(part_);
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = static_cast<int>(plan.quality.iterations);
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS |
                      SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION |
                      SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  info.m_warmstartingFactor = 1;
  // Overlaps are removed by moving the bodies, which gives them no speed.
  info.m_splitImpulse = 1;
  info.m_splitImpulsePenetrationThreshold = 0;
  info.m_erp = 0.8;   // [chosen: four fifths of a joint's error are removed in each step]
  info.m_erp2 = 0.1;  // [chosen: an overlap falls to 1/e in 10 ticks]
  info.m_linearSlop = 1e-4 * plan.step / 1e-3;
  info.m_leastSquaresResidualThreshold = 0;
  add_bodies(plan, first);
  plain_.resize(own_.size());
  rebounds_.reserve(64 * (own_.size() + 1));
  for (const ColliderSet& set : plan.fixed_W) add_fixed(set);
  for (const SolverJoint& joint : plan.joints) add_joint(joint, first);
}

BulletSolver::~BulletSolver() {
  for (auto& constraint : constraints_) world_.removeConstraint(constraint.get());
  for (auto& one : own_) world_.removeRigidBody(one.body.get());
  for (auto& one : fixed_) world_.removeRigidBody(one.get());
}

// The shape of a body without one, which takes part in joints only.
btEmptyShape& no_shape() {
  static btEmptyShape shape;
  return shape;
}

bool is_same(const Floor& a, const Floor& b) {
  return a.height == b.height && a.n_W == b.n_W && a.friction == b.friction;
}

void BulletSolver::add_bodies(const SolverPlan& plan, std::span<const SolverState> first) {
  for (std::size_t i = 0; i < plan.bodies.size(); ++i) {
    const SolverBody& body = plan.bodies[i];
    BulletShapes& shapes = shapes_.emplace_back(body.shape_B, scale_, true);
    btCollisionShape* whole = shapes.whole();
    btRigidBody::btRigidBodyConstructionInfo info(
        body.mass, nullptr, whole != nullptr ? whole : &no_shape(),
        to_bullet(Vector3d(scale_ * scale_ * body.inertia)));
    info.m_startWorldTransform = btTransform(to_bullet(first[i].q_WB), length(first[i].p_WC));
    info.m_friction = body.shape_B.friction;
    info.m_restitution = body.shape_B.restitution;
    auto made = std::make_unique<btRigidBody>(info);
    made->setUserIndex2(static_cast<int>(i));
    made->setActivationState(DISABLE_DEACTIVATION);
    if (!body.turns) made->setAngularFactor(0);
    if (whole != nullptr) {
      const double inner = shapes.inner_radius();
      made->setCcdMotionThreshold(0.5 * inner);
      made->setCcdSweptSphereRadius(0.2 * inner);
      if (body.floor) add_floor(*body.floor);
      world_.addRigidBody(made.get(), btBroadphaseProxy::DefaultFilter,
                          btBroadphaseProxy::AllFilter);
    } else {
      world_.addRigidBody(made.get(), btBroadphaseProxy::DefaultFilter, 0);
    }
    own_.push_back({.body = std::move(made)});
  }
  // Each floor is met by its own bodies only.
  for (const FloorBody& floor : floors_) {
    for (std::size_t i = 0; i < plan.bodies.size(); ++i) {
      const auto& own = plan.bodies[i].floor;
      const bool meets = own && is_same(*own, floor.floor);
      if (!meets) own_[i].body->setIgnoreCollisionCheck(floor.body, true);
    }
  }
}

void BulletSolver::add_floor(const Floor& floor) {
  for (const FloorBody& known : floors_) {
    if (is_same(known.floor, floor)) return;
  }
  btRigidBody* const made = add_fixed(
      {.shapes = {half_space(floor.n_W, floor.height * floor.n_W)}, .friction = floor.friction});
  made->setUserIndex(kPairFriction);
  floors_.push_back({floor, made});
}

// Returns the body; null if there is no shape.
btRigidBody* BulletSolver::add_fixed(const ColliderSet& set) {
  BulletShapes& shapes = shapes_.emplace_back(set, scale_, false);
  if (shapes.whole() == nullptr) return nullptr;
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shapes.whole());
  info.m_startWorldTransform = shapes.place();
  info.m_friction = set.friction;
  info.m_restitution = set.restitution;
  auto made = std::make_unique<btRigidBody>(info);
  if (shapes.is_surface()) {
    made->setCollisionFlags(made->getCollisionFlags() |
                            btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
  }
  world_.addRigidBody(made.get(), btBroadphaseProxy::StaticFilter,
                      btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
  fixed_.push_back(std::move(made));
  return fixed_.back().get();
}

/// Returns a rotation whose z (or x) is along an axis.
Eigen::Matrix3d frame_along(const Vector3d& axis, const Vector3d& own) {
  return Eigen::Quaterniond::FromTwoVectors(own, axis.normalized()).toRotationMatrix();
}

void BulletSolver::add_joint(const SolverJoint& joint, std::span<const SolverState> first) {
  const JointChoice& choice = joint.choice;
  if (!anchor_) {
    anchor_ = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &no_shape()));
  }
  const auto body = [&](int i) -> btRigidBody& {
    return i < 0 ? *anchor_ : *own_[static_cast<std::size_t>(i)].body;
  };
  const auto local = [&](int i, const Eigen::Matrix3d& R_WJ) {
    const btTransform at_W = transform_of(R_WJ, scale_ * choice.p_W);
    if (i < 0) return at_W;
    const SolverState& state = first[static_cast<std::size_t>(i)];

    return btTransform(to_bullet(state.q_WB), length(state.p_WC)).inverseTimes(at_W);
  };
  for (const int i : {joint.a, joint.b}) {
    if (i >= 0) own_[static_cast<std::size_t>(i)].jointed = true;
  }
  btRigidBody &a = body(joint.a), &b = body(joint.b);
  switch (choice.kind) {
    case JointKind::kHinge: {
      const Eigen::Matrix3d R = frame_along(choice.axis_W, Vector3d::UnitZ());
      auto hinge = std::make_unique<btHingeConstraint>(a, b, local(joint.a, R), local(joint.b, R));
      if (choice.limits) {
        hinge->setLimit((*choice.limits)[0], (*choice.limits)[1], 1, 0.3, 0);
      } else {
        hinge->setLimit(1, -1);
      }
      if (choice.speed || choice.friction > 0) {
        const double torque = choice.speed ? choice.motor_max : choice.friction;
        hinge->enableAngularMotor(true, choice.speed.value_or(0), scale_ * scale_ * part_ * torque);
      }
      add_constraint(std::move(hinge));
      break;
    }
    case JointKind::kSlider: {
      const Eigen::Matrix3d R = frame_along(choice.axis_W, Vector3d::UnitX());
      auto slider =
          std::make_unique<btSliderConstraint>(b, a, local(joint.b, R), local(joint.a, R), true);
      slider->setLowerLinLimit(choice.limits ? scale_ * (*choice.limits)[0] : 1);
      slider->setUpperLinLimit(choice.limits ? scale_ * (*choice.limits)[1] : -1);
      slider->setLowerAngLimit(0);
      slider->setUpperAngLimit(0);
      slider->setDampingDirLin(0);
      slider->setDampingLimLin(1);
      if (choice.speed || choice.friction > 0) {
        slider->setPoweredLinMotor(true);
        slider->setTargetLinMotorVelocity(scale_ * choice.speed.value_or(0));
        slider->setMaxLinMotorForce(scale_ * (choice.speed ? choice.motor_max : choice.friction));
      }
      add_constraint(std::move(slider));
      break;
    }
    case JointKind::kBall: {
      const Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
      add_constraint(std::make_unique<btPoint2PointConstraint>(a, b, local(joint.a, R).getOrigin(),
                                                               local(joint.b, R).getOrigin()));
      break;
    }
    case JointKind::kFixed: {
      const Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
      add_constraint(
          std::make_unique<btFixedConstraint>(a, b, local(joint.a, R), local(joint.b, R)));
      break;
    }
    case JointKind::kSpring:
      break;  // a force (CollisionWorld)
  }
}

void BulletSolver::add_constraint(std::unique_ptr<btTypedConstraint> constraint) {
  constraint->setOverrideNumSolverIterations(-1);
  world_.addConstraint(constraint.get(), true);
  constraints_.push_back(std::move(constraint));
}

void BulletSolver::step(std::span<SolverState> bodies, double step) noexcept {
  for (std::size_t i = 0; i < own_.size(); ++i) {
    btRigidBody& body = *own_[i].body;
    const SolverState& state = bodies[i];
    body.setWorldTransform(btTransform(to_bullet(state.q_WB), length(state.p_WC)));
    body.setLinearVelocity(length(state.v_W));
    body.setAngularVelocity(to_bullet(state.omega_W));
    body.setInterpolationWorldTransform(body.getWorldTransform());
    body.setInterpolationLinearVelocity(body.getLinearVelocity());
    body.setInterpolationAngularVelocity(body.getAngularVelocity());
    body.updateInertiaTensor();
    bodies[i].met = own_[i].jointed;
  }
  const double part = step / static_cast<double>(substeps_);
  for (std::size_t i = 0; i < own_.size(); ++i) {
    bodies[i].way_W.setZero();
    bodies[i].turn_W.setZero();
  }
  for (std::size_t k = 0; k < substeps_; ++k) {
    for (std::size_t i = 0; i < own_.size(); ++i) {
      btRigidBody& body = *own_[i].body;
      body.clearForces();
      body.applyCentralForce(length(bodies[i].f_W));
      body.applyTorque(to_bullet(Vector3d(scale_ * scale_ * bodies[i].tau_W)));
    }
    before_ = kinetic_energy();
    world_.stepSimulation(part, 0);
    mark_met(bodies);
    const double share = 1 / static_cast<double>(substeps_);
    for (std::size_t i = 0; i < own_.size(); ++i) {
      const btRigidBody& body = *own_[i].body;
      bodies[i].way_W += share / scale_ * from_bullet(body.getLinearVelocity());
      bodies[i].turn_W += share * from_bullet(body.getAngularVelocity());
    }
    rebound(bodies);
  }
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const btRigidBody& body = *own_[i].body;
    SolverState& state = bodies[i];
    state.p_WC = from_bullet(body.getWorldTransform().getOrigin()) / scale_;
    state.q_WB = from_bullet(body.getWorldTransform().getRotation());
    state.v_W = from_bullet(body.getLinearVelocity()) / scale_;
    state.omega_W = from_bullet(body.getAngularVelocity());
  }
}

double BulletSolver::kinetic_energy() const noexcept {
  double sum = 0;
  for (const Own& own : own_) {
    const btRigidBody& body = *own.body;
    const btVector3 spin_B = body.getAngularVelocity() * body.getWorldTransform().getBasis();
    sum += body.getLinearVelocity().length2() / body.getInvMass() / 2;
    sum += (spin_B * spin_B / body.getInvInertiaDiagLocal()).dot({1, 1, 1}) / 2;
  }
  return sum;
}

// Bullet's own rebounds begin from where the bodies are at the end of a tick, which is inside of
// each other. Here bodies that approach are first stopped where they touch, and then get their
// speed apart.
void BulletSolver::note_approaches() noexcept {
  constexpr double kSlow = 0.02;  // m/s; slower impacts do not rebound [chosen]
  rebounds_.clear();
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      btManifoldPoint& point = manifold.getContactPoint(p);
      const btScalar restitution = pair_restitution(manifold.getBody0(), manifold.getBody1());
      point.m_combinedRestitution = 0;
      if (!(restitution > 0)) continue;
      // Bullet's solver writes only to the bodies of a manifold.
      auto* const a = const_cast<btRigidBody*>(btRigidBody::upcast(manifold.getBody0()));
      auto* const b = const_cast<btRigidBody*>(btRigidBody::upcast(manifold.getBody1()));
      Rebound one;
      one.a = a;
      one.b = b;
      one.point = &point;
      one.normal = point.m_normalWorldOnB;
      one.arm_a = point.getPositionWorldOnA() - a->getWorldTransform().getOrigin();
      one.arm_b = point.getPositionWorldOnB() - b->getWorldTransform().getOrigin();
      const btScalar apart = one.normal.dot(a->getVelocityInLocalPoint(one.arm_a) -
                                            b->getVelocityInLocalPoint(one.arm_b));
      if (!(apart < -scale_ * kSlow)) continue;
      one.wanted = -restitution * apart;
      if (rebounds_.size() < rebounds_.capacity()) rebounds_.push_back(one);
    }
  }
}

// Gives the share (0 to 1) of the rebounds to the velocities without them.
void BulletSolver::push_apart(double share) noexcept {
  for (std::size_t i = 0; i < own_.size(); ++i) {
    own_[i].body->setLinearVelocity(plain_[i].first);
    own_[i].body->setAngularVelocity(plain_[i].second);
  }
  for (const Rebound& one : rebounds_) {
    const btVector3 impulse = share * one.impulse * one.normal;
    one.a->applyImpulse(impulse, one.arm_a);
    one.b->applyImpulse(-impulse, one.arm_b);
  }
}

void BulletSolver::rebound(std::span<const SolverState> bodies) noexcept {
  // A contact without an impulse has not been reached.
  std::erase_if(rebounds_,
                [](const Rebound& one) { return !(one.point->getAppliedImpulse() > 0); });
  if (rebounds_.empty()) return;
  double most = before_;  // the energy without a loss
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const btRigidBody& body = *own_[i].body;
    plain_[i] = {body.getLinearVelocity(), body.getAngularVelocity()};
    most += part_ * (length(bodies[i].f_W).dot(body.getLinearVelocity()) +
                     scale_ * scale_ * to_bullet(bodies[i].tau_W).dot(body.getAngularVelocity()));
  }
  const double least = kinetic_energy();
  constexpr int kRounds = 20;  // [chosen: a row of ten bodies]
  for (int round = 0; round < kRounds; ++round) {
    for (Rebound& one : rebounds_) {
      const btScalar apart = one.normal.dot(one.a->getVelocityInLocalPoint(one.arm_a) -
                                            one.b->getVelocityInLocalPoint(one.arm_b));
      const btScalar gain = one.a->computeImpulseDenominator(
                                one.arm_a + one.a->getCenterOfMassPosition(), one.normal) +
                            one.b->computeImpulseDenominator(
                                one.arm_b + one.b->getCenterOfMassPosition(), one.normal);
      const btScalar total = std::max<btScalar>(one.impulse + (one.wanted - apart) / gain, 0);
      const btVector3 more = (total - one.impulse) * one.normal;
      one.impulse = total;
      one.a->applyImpulse(more, one.arm_a);
      one.b->applyImpulse(-more, one.arm_b);
    }
  }
  if (kinetic_energy() <= most) return;
  // Several contacts with friction may gain energy together. The energy is a
  // quadratic function of the share; two of its values and the one in the middle determine it.
  const double all = kinetic_energy();
  push_apart(0.5);
  const double middle = kinetic_energy();
  const double square = 2 * (all + least) - 4 * middle;
  const double slope = all - least - square;
  double share = 0;
  if (most > least) {
    const double root = slope * slope + 4 * square * (most - least);
    share = square > 0 && root >= 0 ? (std::sqrt(root) - slope) / (2 * square) : 0;
  }
  push_apart(std::clamp(share, 0.0, 1.0));
}

void BulletSolver::mark_met(std::span<SolverState> bodies) noexcept {
  ++counters_.steps;
  std::uint64_t contacts = 0;
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    bool acts = false;
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold.getContactPoint(p);
      // Bullet may leave an impulse along the surface at a point without one across it.
      const bool rubs = point.m_appliedImpulseLateral1 != 0 || point.m_appliedImpulseLateral2 != 0;
      if (!(point.getAppliedImpulse() > 0) && !(point.getDistance() < 0) && !rubs) continue;
      acts = true;
      if (point.getAppliedImpulse() > 0) ++contacts;
    }
    if (!acts) continue;
    for (const btCollisionObject* object : {manifold.getBody0(), manifold.getBody1()}) {
      const int i = object->getUserIndex2();  // -1: not a body
      if (i >= 0) bodies[static_cast<std::size_t>(i)].met = true;
    }
  }
  counters_.contacts += contacts;
  counters_.contacts_max = std::max(counters_.contacts_max, contacts);
}

}  // namespace

driver::Result<std::unique_ptr<CollisionSolver>> build_collision_solver(
    const SolverPlan& plan, std::span<const SolverState> first) {
  return std::unique_ptr<CollisionSolver>(std::make_unique<BulletSolver>(plan, first));
}

}  // namespace thimble::render
