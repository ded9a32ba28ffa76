#include <BulletCollision/CollisionDispatch/btInternalEdgeUtility.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

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

class BulletSolver final : public CollisionSolver {
 public:
  BulletSolver(const SolverPlan& plan, std::span<const SolverState> first);
  ~BulletSolver() override;

  void step(std::span<SolverState> bodies, double step) noexcept override;
  const SolverCounters& counters() const noexcept override { return counters_; }

 private:
  void add_bodies(const SolverPlan& plan, std::span<const SolverState> first);
  void add_fixed(const ColliderSet& set);
  void add_floor(const Floor& floor);
  void add_joint(const SolverJoint& joint, std::span<const SolverState> first);
  void add_constraint(std::unique_ptr<btTypedConstraint> constraint);
  void mark_met(std::span<SolverState> bodies) noexcept;
  btVector3 length(const Vector3d& v) const noexcept { return to_bullet(Vector3d(scale_ * v)); }

  struct Own {
    std::unique_ptr<btRigidBody> body;
    bool turns = true;
    bool jointed = false;
  };
  struct FloorBody {
    Floor floor;
    std::unique_ptr<btRigidBody> body;
  };

  double scale_ = 1;  // Bullet's units per m
  std::size_t substeps_ = 1;
  double part_ = 1e-3;  // s, of a substep
  std::vector<BulletShapes> shapes_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver impulses_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &impulses_, &configuration_};
  std::vector<Own> own_;
  std::vector<std::unique_ptr<btRigidBody>> fixed_;
  std::vector<FloorBody> floors_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
  std::unique_ptr<btRigidBody> anchor_;  // the world, for joints
  SolverCounters counters_;
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
  // Round bodies get up to three points in one step. [Bullet: its own number for bodies on planes]
  configuration_.setConvexConvexMultipointIterations(3, 3);
  world_.setGravity({0, 0, 0});
  world_.setForceUpdateAllAabbs(false);
  // Two boxes, or hulls, that lie on each other get all corners of their common face at once.
  world_.getDispatchInfo().m_enableSatConvex = true;
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = static_cast<int>(plan.quality.iterations);
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS |
                      SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION |
                      SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  info.m_warmstartingFactor = 1;
  // Overlaps are removed by moving the bodies, which gives them no speed.
  info.m_splitImpulse = 1;
  info.m_splitImpulsePenetrationThreshold = 0;
  info.m_erp2 = 0.1;  // [chosen: an overlap falls to 1/e in 10 ticks]
  info.m_linearSlop = 1e-4 * plan.step / 1e-3;
  info.m_restitutionVelocityThreshold = scale_ * 0.02;  // [chosen: 0.02 m/s; slower impacts end]
  info.m_leastSquaresResidualThreshold = 0;
  add_bodies(plan, first);
  for (const ColliderSet& set : plan.fixed_W) add_fixed(set);
  for (const SolverJoint& joint : plan.joints) add_joint(joint, first);
}

BulletSolver::~BulletSolver() {
  for (auto& constraint : constraints_) world_.removeConstraint(constraint.get());
  for (auto& one : own_) world_.removeRigidBody(one.body.get());
  for (auto& one : fixed_) world_.removeRigidBody(one.get());
  for (auto& one : floors_) world_.removeRigidBody(one.body.get());
}

void BulletSolver::add_bodies(const SolverPlan& plan, std::span<const SolverState> first) {
  // A body without a shape takes part in joints only.
  static btEmptyShape nothing;
  for (std::size_t i = 0; i < plan.bodies.size(); ++i) {
    const SolverBody& body = plan.bodies[i];
    BulletShapes& shapes = shapes_.emplace_back(body.shape_B, scale_, true);
    btCollisionShape* whole = shapes.whole();
    btRigidBody::btRigidBodyConstructionInfo info(
        body.mass, nullptr, whole != nullptr ? whole : &nothing,
        to_bullet(Vector3d(scale_ * scale_ * body.inertia)));
    info.m_startWorldTransform = btTransform(to_bullet(first[i].q_WB), length(first[i].p_WC));
    info.m_friction = body.shape_B.friction;
    info.m_restitution = body.shape_B.restitution;
    auto made = std::make_unique<btRigidBody>(info);
    made->setUserIndex2(static_cast<int>(i));
    made->setActivationState(DISABLE_DEACTIVATION);
    if (!body.turns) made->setAngularFactor(0);
    if (whole != nullptr) {
      // A rebound is computed from the speed at the touch. So what rebounds is not stopped ahead.
      if (body.shape_B.restitution > 0) made->setContactProcessingThreshold(1e-6);
      const double inner = shapes.inner_radius();
      made->setCcdMotionThreshold(0.5 * inner);
      made->setCcdSweptSphereRadius(0.2 * inner);
      if (body.floor) add_floor(*body.floor);
      world_.addRigidBody(made.get(), btBroadphaseProxy::DefaultFilter,
                          btBroadphaseProxy::AllFilter);
    } else {
      world_.addRigidBody(made.get(), btBroadphaseProxy::DefaultFilter, 0);
    }
    own_.push_back({.body = std::move(made), .turns = body.turns});
  }
  // Each floor is met by its own bodies only.
  for (auto& floor : floors_) {
    for (std::size_t i = 0; i < plan.bodies.size(); ++i) {
      const auto& own = plan.bodies[i].floor;
      const bool same = own && own->height == floor.floor.height && own->n_W == floor.floor.n_W &&
                        own->friction == floor.floor.friction;
      if (!same) own_[i].body->setIgnoreCollisionCheck(floor.body.get(), true);
    }
  }
}

void BulletSolver::add_floor(const Floor& floor) {
  for (const FloorBody& known : floors_) {
    if (known.floor.height == floor.height && known.floor.n_W == floor.n_W &&
        known.floor.friction == floor.friction) {
      return;
    }
  }
  ColliderSet set;
  Collider plane;
  plane.form = ColliderForm::kHalfSpace;
  plane.R = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), floor.n_W).toRotationMatrix();
  plane.p = floor.height * floor.n_W;
  set.shapes.push_back(plane);
  set.friction = floor.friction;
  add_fixed(set);
  fixed_.back()->setUserIndex(kPairFriction);
  floors_.push_back({floor, std::move(fixed_.back())});
  fixed_.pop_back();
}

void BulletSolver::add_fixed(const ColliderSet& set) {
  BulletShapes& shapes = shapes_.emplace_back(set, scale_, false);
  if (shapes.whole() == nullptr) return;
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shapes.whole());
  info.m_friction = set.friction;
  info.m_restitution = set.restitution;
  auto made = std::make_unique<btRigidBody>(info);
  if (set.restitution > 0) made->setContactProcessingThreshold(1e-6);
  if (shapes.is_surface()) {
    made->setCollisionFlags(made->getCollisionFlags() |
                            btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
  }
  world_.addRigidBody(made.get(), btBroadphaseProxy::StaticFilter,
                      btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
  fixed_.push_back(std::move(made));
}

/// Returns a rotation whose z (or x) is along an axis.
Eigen::Matrix3d frame_along(const Vector3d& axis, const Vector3d& own) {
  return Eigen::Quaterniond::FromTwoVectors(own, axis.normalized()).toRotationMatrix();
}

void BulletSolver::add_joint(const SolverJoint& joint, std::span<const SolverState> first) {
  const JointChoice& choice = joint.choice;
  if (!anchor_) {
    static btEmptyShape nothing;
    anchor_ = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &nothing));
  }
  const auto body = [&](int i) -> btRigidBody& {
    return i < 0 ? *anchor_ : *own_[static_cast<std::size_t>(i)].body;
  };
  const auto local = [&](int i, const Eigen::Matrix3d& R_WJ) {
    const btTransform at_W = transform_of(R_WJ, scale_ * choice.p_W);
    if (i < 0) return at_W;
    const SolverState& state = first[static_cast<std::size_t>(i)];
    return btTransform(to_bullet(state.q_WB), length(state.p_WC)).inverse() * at_W;
  };
  for (const int i : {joint.a, joint.b}) {
    if (i >= 0) own_[static_cast<std::size_t>(i)].jointed = true;
  }
  btRigidBody &a = body(joint.a), &b = body(joint.b);
  switch (choice.kind) {
    case JointKind::kHinge: {
      const Eigen::Matrix3d R = frame_along(choice.axis_W, Vector3d::UnitZ());
      auto hinge = std::make_unique<btHingeConstraint>(b, a, local(joint.b, R), local(joint.a, R));
      // Bullet's hinge counts the angle of its first body relative to the second.
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
      break;  // a force of its own (CollisionWorld)
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
  for (std::size_t k = 0; k < substeps_; ++k) {
    for (std::size_t i = 0; i < own_.size(); ++i) {
      btRigidBody& body = *own_[i].body;
      body.clearForces();
      body.applyCentralForce(length(bodies[i].f_W));
      body.applyTorque(to_bullet(Vector3d(scale_ * scale_ * bodies[i].tau_W)));
    }
    world_.stepSimulation(part, 0);
    mark_met(bodies);
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

void BulletSolver::mark_met(std::span<SolverState> bodies) noexcept {
  ++counters_.steps;
  std::uint64_t contacts = 0;
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    bool acts = false;
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold.getContactPoint(p);
      if (!(point.getAppliedImpulse() > 0) && !(point.getDistance() < 0)) continue;
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
