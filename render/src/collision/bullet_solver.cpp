#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "body/motion/free_turn.h"
#include "body/motion/turn.h"
#include "collision/box_pair.h"
#include "collision/bullet_joints.h"
#include "collision/bullet_shapes.h"
#include "collision/bullet_units.h"
#include "collision/bullet_world.h"
#include "collision/collision_solver.h"
#include "collision/plane_contacts.h"
#include "collision/rebounds.h"
#include "collision/round_contacts.h"
#include "collision/surface_contacts.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

class BulletSolver final : public CollisionSolver {
 public:
  BulletSolver(const SolverPlan& plan, std::span<const SolverState> first);
  ~BulletSolver() override;

  void step(std::span<SolverState> bodies, double step) noexcept override;
  std::vector<SolverOverlap> overlaps() override;
  const SolverCounters& counters() const noexcept override { return counters_; }
  /// Called by the world between finding contacts and computing their impulses.
  void note_approaches() noexcept;

 private:
  struct Own {
    std::unique_ptr<btRigidBody> body;
    bool jointed = false;
    Vector3d inertia;  // kg m^2 about the axes of B
    FreeTurn free_turn;
    // Before the loads of a substep.
    Eigen::Quaterniond begin = Eigen::Quaterniond::Identity();
    btVector3 v{0, 0, 0};
    btVector3 omega{0, 0, 0};
  };
  void add_bodies(const SolverPlan& plan, std::span<const SolverState> first);
  btRigidBody* add_fixed(const ColliderSet& set);
  void add_floor(const Floor& floor);
  void add_joint(const SolverJoint& joint, std::span<const SolverState> first);
  static void turn_freely(const Own& own, double time) noexcept;
  std::pair<btVector3, btVector3> under_load(const Own& own, const SolverState& state,
                                             double part) const noexcept;
  void keep_velocities() noexcept;
  void bound_energy(std::span<const SolverState> bodies, double part, double most) noexcept;
  void aim_friction(btManifoldPoint& point, const btRigidBody& a,
                    const btRigidBody& b) const noexcept;
  void rebound(double most) noexcept;
  btVector3 velocity_before(const btRigidBody& body, const btVector3& arm) const noexcept;
  double kinetic_energy() const noexcept;
  void mark_met(std::span<SolverState> bodies) noexcept;
  btVector3 length(const Vector3d& v) const noexcept { return to_bullet(Vector3d(scale_ * v)); }

  struct FloorBody {
    Floor floor;
    btRigidBody* body = nullptr;  // one of `fixed_`
  };

  double scale_ = 1;  // Bullet's units per m
  std::size_t substeps_ = 1;
  double part_ = 1e-3;  // s, of a substep
  bool has_motor_ = false;
  std::vector<BulletShapes> shapes_;
  btDefaultCollisionConfiguration configuration_;
  BoxPairs box_pairs_;
  PlaneContacts plane_contacts_;
  RoundContacts round_contacts_;
  SurfaceContacts surface_contacts_;
  btGjkEpaPenetrationDepthSolver penetration_;
  btConvexConvexAlgorithm::CreateFunc single_points_{&penetration_};
  ForesightedDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  RoomyImpulses impulses_;
  ObservedWorld world_{&dispatcher_, &broadphase_, &impulses_, &configuration_};
  std::vector<Own> own_;
  std::vector<std::unique_ptr<btRigidBody>> fixed_;
  std::vector<FloorBody> floors_;
  std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
  std::unique_ptr<btRigidBody> anchor_;  // the world, for joints
  SolverCounters counters_;
  Rebounds rebounds_;
  std::vector<std::pair<btVector3, btVector3>> plain_;  // kept velocities
};

/// Returns the size of the smallest body: its radius of gyration, m.
double smallest_size(const SolverPlan& plan) {
  double least = std::numeric_limits<double>::infinity();
  for (const SolverBody& body : plan.bodies) {
    least = std::min(least, std::sqrt(body.inertia.sum() / body.mass));
  }
  return plan.bodies.empty() ? 1 : least;
}

BulletSolver::BulletSolver(const SolverPlan& plan, std::span<const SolverState> first)
    : scale_(1 / smallest_size(plan)),
      substeps_(std::max<std::size_t>(plan.quality.substeps, 1)),
      part_(plan.step * static_cast<double>(std::max<std::size_t>(plan.quality.every, 1)) /
            static_cast<double>(substeps_)) {
  set_pair_rules();
  btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
  // Pairs without an algorithm of ours get up to three points in one step [Bullet].
  configuration_.setConvexConvexMultipointIterations(3, 3);
  world_.setGravity({0, 0, 0});
  world_.observe(this);
  world_.setForceUpdateAllAabbs(false);
  // Bullet's own algorithms for two boxes and two spheres find no contact ahead.
  dispatcher_.registerCollisionCreateFunc(BOX_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE, &box_pairs_);
  const auto meet_by = [this](int a, int b, btCollisionAlgorithmCreateFunc& algorithm) {
    dispatcher_.registerCollisionCreateFunc(a, b, &algorithm);
    dispatcher_.registerCollisionCreateFunc(b, a, &algorithm);
  };
  for (int other = 0; other < CONCAVE_SHAPES_START_HERE; ++other) {
    meet_by(other, SPHERE_SHAPE_PROXYTYPE, single_points_);
    meet_by(other, TRIANGLE_MESH_SHAPE_PROXYTYPE, surface_contacts_);
    meet_by(other, STATIC_PLANE_PROXYTYPE, plane_contacts_);
  }
  constexpr int kRound[] = {CYLINDER_SHAPE_PROXYTYPE, CAPSULE_SHAPE_PROXYTYPE,
                            CONE_SHAPE_PROXYTYPE};
  for (const int round : kRound) {
    meet_by(round, BOX_SHAPE_PROXYTYPE, round_contacts_);
    meet_by(round, CONVEX_HULL_SHAPE_PROXYTYPE, round_contacts_);
    for (const int other : kRound) meet_by(round, other, single_points_);
  }
  dispatcher_.look_ahead(part_);
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = static_cast<int>(plan.quality.iterations);
  // The directions of friction are those of aim_friction.
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS |
                      SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  info.m_warmstartingFactor = 1;
  // Overlaps are removed by moving the bodies, which gives them no speed.
  info.m_splitImpulse = 1;
  info.m_splitImpulsePenetrationThreshold = 0;
  info.m_erp = 0.8;  // [chosen: four fifths of a joint's error are removed in each step]
  // Share of an overlap that is removed in each step [chosen: slowly, because it lifts bodies; in
  // larger steps a hand makes larger overlaps].
  info.m_erp2 = plan.quality.every > 1 ? 0.1 : 0.01;
  info.m_linearSlop = 1e-4 * plan.step / 1e-3;
  // No impulse changes a velocity by more in the last iteration. [chosen: 1e-6 of the weight in a
  // tick]
  constexpr double kSettled = 1e-8;  // m/s
  info.m_leastSquaresResidualThreshold = scale_ * scale_ * kSettled * kSettled;
  add_bodies(plan, first);
  plain_.resize(own_.size());
  constexpr double kSlow = 0.02;  // m/s; slower impacts do not rebound [chosen]
  rebounds_.prepare(64 * (own_.size() + 1), scale_ * kSlow);
  for (std::size_t k = 0; k < plan.fixed_W.size(); ++k) {
    btRigidBody* const made = add_fixed(plan.fixed_W[k]);
    if (made != nullptr) made->setUserIndex3(static_cast<int>(k));
  }
  for (const SolverJoint& joint : plan.joints) add_joint(joint, first);
  // A body in a heap has six neighbours with up to four points each, half of them its own.
  constexpr std::size_t kContacts = 12;
  impulses_.reserve(static_cast<int>(own_.size() + fixed_.size()),
                    static_cast<int>(kContacts * (own_.size() + 4)),
                    static_cast<int>(plan.joints.size()));
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
    made->setFlags(0);  // without Bullet's gyroscopic torque: turn_freely
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
    own_.push_back({.body = std::move(made),
                    .jointed = false,
                    .inertia = body.inertia,
                    .free_turn = FreeTurn(body.inertia),
                    .begin = first[i].q_WB,
                    .v = {0, 0, 0},
                    .omega = {0, 0, 0}});
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

void BulletSolver::add_joint(const SolverJoint& joint, std::span<const SolverState> first) {
  if (!anchor_) {
    anchor_ = std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &no_shape()));
  }
  const auto end = [&](int i) -> JointEnd {
    if (i < 0) return {*anchor_, btTransform::getIdentity()};
    Own& own = own_[static_cast<std::size_t>(i)];
    own.jointed = true;
    const SolverState& state = first[static_cast<std::size_t>(i)];
    return {*own.body, btTransform(to_bullet(state.q_WB), length(state.p_WC))};
  };
  has_motor_ = has_motor_ || joint.choice.speed.has_value();
  auto constraint = joint_of(joint.choice, end(joint.a), end(joint.b), scale_, part_);
  if (constraint == nullptr) return;
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
    double most = kinetic_energy();  // that the bodies may have after the substep
    for (std::size_t i = 0; i < own_.size(); ++i) {
      Own& own = own_[i];
      btRigidBody& body = *own.body;
      own.begin = from_bullet(body.getWorldTransform().getRotation());
      own.v = body.getLinearVelocity();
      own.omega = body.getAngularVelocity();
      // Loads as velocities: Bullet's rows of friction do not count torques.
      const auto [v, omega] = under_load(own, bodies[i], part);
      body.setLinearVelocity(v);
      body.setAngularVelocity(omega);
    }
    world_.stepSimulation(part, 0);
    mark_met(bodies);
    const double share = 1 / static_cast<double>(substeps_);
    for (std::size_t i = 0; i < own_.size(); ++i) {
      const btRigidBody& body = *own_[i].body;
      bodies[i].way_W += share / scale_ * from_bullet(body.getLinearVelocity());
      bodies[i].turn_W += share * from_bullet(body.getAngularVelocity());
    }
    for (const Own& own : own_) turn_freely(own, part);
    for (std::size_t i = 0; i < own_.size(); ++i) {
      most += part * (bodies[i].f_W.dot(from_bullet(own_[i].body->getLinearVelocity())) * scale_ +
                      scale_ * scale_ *
                          bodies[i].tau_W.dot(from_bullet(own_[i].body->getAngularVelocity())));
    }
    if (!has_motor_) bound_energy(bodies, part, most);
    if (rebounds_.any()) rebound(most);
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

// Bullet turns a body at a constant angular velocity. Here its angular momentum after the impulses
// is kept, and it turns as a free body does.
void BulletSolver::turn_freely(const Own& own, double time) noexcept {
  btRigidBody& body = *own.body;
  const Vector3d omega_W = from_bullet(body.getAngularVelocity());
  const Eigen::Quaterniond before = own.begin;
  const Eigen::Quaterniond bullets = from_bullet(body.getWorldTransform().getRotation());
  const Vector3d spin_B = before.conjugate() * omega_W;
  const Vector3d momentum_W = before * Vector3d(own.inertia.cwiseProduct(spin_B));
  Eigen::Quaterniond now = before;
  own.free_turn.turn(time, momentum_W, now);
  // What Bullet has turned it to leave an overlap.
  now = bullets * (turn_by(time * omega_W) * before).conjugate() * now;
  btTransform place = body.getWorldTransform();
  place.setRotation(to_bullet(now.normalized()));
  body.setWorldTransform(place);
  const Vector3d after_B = (now.conjugate() * momentum_W).cwiseQuotient(own.inertia);
  body.setAngularVelocity(to_bullet(Vector3d(now * after_B)));
  body.updateInertiaTensor();
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

// Bullet bounds friction in two directions, each by itself. Along the motion it is that of Coulomb.
void BulletSolver::aim_friction(btManifoldPoint& point, const btRigidBody& a,
                                const btRigidBody& b) const noexcept {
  constexpr double kStill = 1e-4;  // m/s; slower points keep fixed directions [chosen]
  const btVector3& n = point.m_normalWorldOnB;
  const btVector3 apart =
      a.getVelocityInLocalPoint(point.getPositionWorldOnA() - a.getCenterOfMassPosition()) -
      b.getVelocityInLocalPoint(point.getPositionWorldOnB() - b.getCenterOfMassPosition());
  const btVector3 along = apart - n * n.dot(apart);
  btVector3& first = point.m_lateralFrictionDir1;
  if (along.length2() > scale_ * scale_ * kStill * kStill) {
    first = along.normalized();
    point.m_lateralFrictionDir2 = btCross(first, n);
  } else {
    btPlaneSpace1(n, first, point.m_lateralFrictionDir2);
  }
  point.m_contactPointFlags |= BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
}

// Returns the velocity of a point of a body before the loads of a substep.
btVector3 BulletSolver::velocity_before(const btRigidBody& body,
                                        const btVector3& arm) const noexcept {
  const int i = body.getUserIndex2();  // -1: not a body
  if (i < 0) return {0, 0, 0};
  const Own& own = own_[static_cast<std::size_t>(i)];
  return own.v + btCross(own.omega, arm);
}

void BulletSolver::note_approaches() noexcept {
  rebounds_.clear();
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      btManifoldPoint& point = manifold.getContactPoint(p);
      const btScalar restitution = pair_restitution(manifold.getBody0(), manifold.getBody1());
      point.m_combinedRestitution = 0;
      // Bullet's solver writes only to the bodies of a manifold.
      auto* const a = const_cast<btRigidBody*>(btRigidBody::upcast(manifold.getBody0()));
      auto* const b = const_cast<btRigidBody*>(btRigidBody::upcast(manifold.getBody1()));
      aim_friction(point, *a, *b);
      if (!(restitution > 0)) continue;
      const btVector3 arm_a = point.getPositionWorldOnA() - a->getCenterOfMassPosition();
      const btVector3 arm_b = point.getPositionWorldOnB() - b->getCenterOfMassPosition();
      const btScalar apart =
          point.m_normalWorldOnB.dot(velocity_before(*a, arm_a) - velocity_before(*b, arm_b));
      rebounds_.note(point, *a, *b, arm_a, arm_b, -apart, restitution);
    }
  }
}

// Returns the velocities of a body after the loads of a substep, without contacts and joints.
std::pair<btVector3, btVector3> BulletSolver::under_load(const Own& own, const SolverState& state,
                                                         double part) const noexcept {
  const btVector3 torque = to_bullet(Vector3d(scale_ * scale_ * state.tau_W));
  return {own.v + part * own.body->getInvMass() * length(state.f_W),
          own.omega + part * (own.body->getInvInertiaTensorWorld() * torque)};
}

void BulletSolver::keep_velocities() noexcept {
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const btRigidBody& body = *own_[i].body;
    plain_[i] = {body.getLinearVelocity(), body.getAngularVelocity()};
  }
}

// Impulses of Bullet that have not converged, or began from those of the last step, may give
// energy. Then all impulses of this step are a little smaller, which keeps the momentum.
void BulletSolver::bound_energy(std::span<const SolverState> bodies, double part,
                                double most) noexcept {
  const double all = kinetic_energy();
  if (all <= most) return;
  keep_velocities();
  const auto take = [&](double share) {
    for (std::size_t i = 0; i < own_.size(); ++i) {
      const Own& own = own_[i];
      btRigidBody& body = *own.body;
      const auto [v, omega] = under_load(own, bodies[i], part);
      body.setLinearVelocity(v + share * (plain_[i].first - v));
      body.setAngularVelocity(omega + share * (plain_[i].second - omega));
    }
    return kinetic_energy();
  };
  const double none = take(0), half = take(0.5);
  take(share_within(most, none, half, all));
}

void BulletSolver::rebound(double most) noexcept {
  keep_velocities();
  const double none = kinetic_energy();
  rebounds_.solve();
  // Several contacts with friction may gain energy together.
  const double all = kinetic_energy();
  if (all <= most) return;
  const auto take = [&](double share) {
    for (std::size_t i = 0; i < own_.size(); ++i) {
      own_[i].body->setLinearVelocity(plain_[i].first);
      own_[i].body->setAngularVelocity(plain_[i].second);
    }
    rebounds_.give(share);
    return kinetic_energy();
  };
  take(share_within(most, none, take(0.5), all));
}

std::vector<SolverOverlap> BulletSolver::overlaps() {
  world_.find_contacts();
  std::vector<SolverOverlap> found;
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    btScalar depth = 0;
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      depth = std::max(depth, -manifold.getContactPoint(p).getDistance());
    }
    SolverOverlap one;
    double size = std::numeric_limits<double>::infinity();
    for (const btCollisionObject* object : {manifold.getBody0(), manifold.getBody1()}) {
      const int i = object->getUserIndex2();
      if (i < 0) {
        one.fixed = object->getUserIndex3();
        continue;
      }
      (one.body < 0 ? one.body : one.other) = i;
      const Own& own = own_[static_cast<std::size_t>(i)];
      size = std::min(size, std::sqrt(own.inertia.sum() * own.body->getInvMass()));
    }
    one.depth = depth / scale_;
    if (one.body < 0 || !(one.depth > 0.01 * size)) continue;
    const auto same = std::find_if(found.begin(), found.end(), [&](const SolverOverlap& known) {
      return known.body == one.body && known.other == one.other && known.fixed == one.fixed;
    });
    if (same == found.end()) {
      found.push_back(one);
    } else {
      same->depth = std::max(same->depth, one.depth);
    }
  }
  return found;
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
