#include "collision/collision_world.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "body/motion/body_coupling.h"
#include "body/motion/move_object.h"
#include "body/motion/turn.h"
#include "math/elementary.h"

namespace thimble::render {

using Eigen::Vector3d;

driver::Result<void> add_body(const SolidToCollide& solid, const CollisionChoice& collision,
                              MotionChoice choice, SolverPlan& plan,
                              std::vector<CollisionWorld::Member>& members) {
  // The solver has the floor.
  const std::optional<Floor> floor = std::exchange(choice.floor, std::nullopt);
  const auto axes_W = axes_of(solid);
  auto motion = rigid_motion_of(*solid.mesh_W, choice, axes_W ? &*axes_W : nullptr);
  if (!motion) return motion.error();
  const MassProperties& mass = motion->body().settings().mass;
  auto set = collider_of(solid, collision, PlaceOfBody{mass.q_WB.toRotationMatrix(), mass.p_WC});
  if (!set) return set.error();
  const bool turns = choice.kind == MotionKind::kRigid;
  plan.bodies.push_back({.mass = mass.mass,
                         .inertia = mass.inertia,
                         .turns = turns,
                         .shape_B = std::move(set).value(),
                         .floor = floor});
  members.push_back({std::move(motion).value(), turns});
  return {};
}

SpringJoint spring_of(const JointChoice& choice, int a, int b) {
  return {.a = a,
          .b = b,
          .p_A = choice.p_W,
          .p_B = choice.p_end_W,
          .stiffness = choice.stiffness,
          .damping = choice.damping,
          .length = choice.length.value_or((choice.p_end_W - choice.p_W).norm())};
}

driver::Result<std::shared_ptr<CollisionWorld>> CollisionWorld::build(
    std::vector<Member> members, const SolverPlan& plan, std::vector<SpringJoint> springs,
    std::size_t hands) {
  std::shared_ptr<CollisionWorld> world(new CollisionWorld);
  world->members_ = std::move(members);
  world->springs_ = std::move(springs);
  world->hands_ = hands;
  for (const Member& member : world->members_) {
    const RigidBody& body = member.motion.body();
    world->states_.push_back({.p_WC = body.p_WC(), .q_WB = body.q_WB()});
  }
  auto solver = build_collision_solver(plan, world->states_);
  if (!solver) return solver.error();
  world->solver_ = std::move(solver).value();
  world->every_ = std::max<std::size_t>(plan.quality.every, 1);
  world->loads_.resize(world->members_.size());
  world->courses_.resize(world->members_.size());
  world->pushes_.resize(hands * world->members_.size());
  world->given_.resize(hands);
  world->first_ = world->energy();
  return world;
}

double CollisionWorld::energy() const noexcept {
  double sum = 0;
  for (const Member& member : members_) sum += member.motion.energy();
  for (const SpringJoint& spring : springs_) {
    const auto at = [&](int i, const Vector3d& p) -> Vector3d {
      if (i < 0) return p;
      const RigidMotion& motion = members_[static_cast<std::size_t>(i)].motion;
      return motion.p_WB() + motion.R_WB() * p;
    };
    const double x = (at(spring.b, spring.p_B) - at(spring.a, spring.p_A)).norm() - spring.length;
    sum += spring.stiffness * x * x / 2;
  }
  return sum;
}

double CollisionWorld::energy_for(std::size_t hand) const noexcept {
  double sum = energy() + lost_;
  for (std::size_t i = 0; i < hands_; ++i) {
    if (i != hand) sum -= given_[i];
  }
  return sum;
}

Vector3d CollisionWorld::gain_at(std::size_t body, const Vector3d& p_W,
                                 const Vector3d& impulse) const noexcept {
  const Member& member = members_[body];
  if (!member.turns) return impulse / member.motion.body().settings().mass.mass;
  return member.motion.gain_at(p_W, impulse);
}

void CollisionWorld::push_at(std::size_t body, const Vector3d& f_W, const Vector3d& p_W) noexcept {
  constexpr double kForceMax = 1e6;  // N, N m; no arm pushes harder
  Load& load = loads_[body];
  const Vector3d tau_W = (p_W - members_[body].motion.body().p_WC()).cross(f_W);
  // Written so that NaN means no force.
  if (!(f_W.squaredNorm() <= kForceMax * kForceMax)) return;
  if (!(tau_W.squaredNorm() <= kForceMax * kForceMax)) return;
  load.f_W += f_W;
  if (members_[body].turns) load.tau_W += tau_W;
}

void CollisionWorld::push(std::size_t hand, std::size_t body, const Vector3d& f_W,
                          const Vector3d& p_W) noexcept {
  push_at(body, f_W, p_W);
  Push& push = push_of(hand, body);
  push.f_W = f_W;
  push.p_W = p_W;
}

// The force of the place where the step ends, as MovingTouch (body_coupling.h). Both ends get it on
// one line, so that angular momentum is kept.
void CollisionWorld::pull_springs(double step) noexcept {
  for (const SpringJoint& spring : springs_) {
    struct End {
      Vector3d p_W, v_W;
    };
    const auto end_of = [&](int i, const Vector3d& p) -> End {
      if (i < 0) return {p, Vector3d::Zero()};
      const RigidMotion& motion = members_[static_cast<std::size_t>(i)].motion;
      const BodyFrame frame = motion.frame_after(step);
      const Vector3d p_W = frame.p_WB + frame.R_WB * p;
      return {p_W, motion.velocity_at(p_W)};
    };
    const End a = end_of(spring.a, spring.p_A), b = end_of(spring.b, spring.p_B);
    const Vector3d way = b.p_W - a.p_W;
    const double length = way.norm();
    if (!(length > 0)) continue;
    const Vector3d u = way / length;
    double gain = 0;
    for (const auto& [i, p_W] : {std::pair(spring.a, a.p_W), std::pair(spring.b, b.p_W)}) {
      if (i >= 0) gain += u.dot(gain_at(static_cast<std::size_t>(i), p_W, u));
    }
    const double grip = (spring.stiffness * step + spring.damping) * step;
    const double f =
        (spring.stiffness * (length - spring.length) + spring.damping * u.dot(b.v_W - a.v_W)) /
        (1 + grip * gain);
    if (spring.a >= 0) push_at(static_cast<std::size_t>(spring.a), f * u, a.p_W);
    if (spring.b >= 0) push_at(static_cast<std::size_t>(spring.b), -f * u, b.p_W);
  }
}

void CollisionWorld::end_of_body(double step) noexcept {
  if (hands_ != 1 || ++ended_ < members_.size()) return;
  ended_ = 0;
  this->step(step);
}

// The free flight of each body is computed beside the solver's step.
void CollisionWorld::solve(double step) noexcept {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const RigidBody& body = members_[i].motion.body();
    const RigidBodySettings& settings = body.settings();
    SolverState& state = states_[i];
    Course& course = courses_[i];
    const auto ticks = static_cast<double>(every_);
    course = {.assumed = {course.sum.f_W / ticks, course.sum.tau_W / ticks}};
    state.f_W = course.assumed.f_W;
    state.tau_W = course.assumed.tau_W;
    state.p_WC = body.p_WC();
    state.q_WB = body.q_WB();
    state.v_W = body.v_WC();
    state.omega_W = body.omega_W();
    state.f_W += settings.mass.mass * settings.gravity_W;
    // Damping as the force that has its effect over the step.
    if (settings.damping > 0) {
      const double fade = math::expm1(-settings.damping / settings.mass.mass * step);
      state.f_W += settings.mass.mass * fade / step * state.v_W;
    }
    if (settings.angular_damping > 0) {
      Vector3d omega_B = state.q_WB.conjugate() * state.omega_W;
      for (int k = 0; k < 3; ++k) {
        const double inertia = settings.mass.inertia[k];
        omega_B[k] *= inertia * math::expm1(-settings.angular_damping / inertia * step) / step;
      }
      state.tau_W += state.q_WB * omega_B;
    }
  }
  solver_->step(states_, step);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const RigidBody& body = members_[i].motion.body();
    SolverState& state = states_[i];
    // Written so that a result that is NaN is not used.
    const bool known = state.p_WC.allFinite() && state.q_WB.coeffs().allFinite() &&
                       state.v_W.allFinite() && state.omega_W.allFinite();
    state.met = state.met && known;
    if (!state.met || every_ == 1) continue;
    courses_[i].v_W = (state.p_WC - body.p_WC()) / step;
    courses_[i].omega_W = turn_between(body.q_WB(), state.q_WB) / step;
  }
}

// The solver has applied the loads of its tick over the whole step. What later ticks differ from
// them moves the body as a free one, up to the next step.
void CollisionWorld::follow_course(std::size_t i, double step) noexcept {
  Course& course = courses_[i];
  SolverState& state = states_[i];
  RigidMotion& motion = members_[i].motion;
  const RigidBody& body = motion.body();
  const MassProperties& mass = body.settings().mass;
  const Vector3d gain_v = step / mass.mass * (loads_[i].f_W - course.assumed.f_W);
  Vector3d gain_omega(0, 0, 0);
  if (members_[i].turns) {
    const Vector3d tau_B = body.q_WB().conjugate() * (loads_[i].tau_W - course.assumed.tau_W);
    gain_omega = step * (body.q_WB() * tau_B.cwiseQuotient(mass.inertia));
  }
  state.way_W = course.v_W + course.more_v_W + gain_v / 2;
  state.turn_W = course.omega_W + course.more_omega_W + gain_omega / 2;
  course.more_v_W += gain_v;
  course.more_omega_W += gain_omega;
  motion.place(body.p_WC() + step * state.way_W, turn_by(step * state.turn_W) * body.q_WB(),
               state.v_W + course.more_v_W, state.omega_W + course.more_omega_W);
}

void CollisionWorld::step(double step) noexcept {
  // Written so that NaN moves nothing.
  if (!(step > 0) || !std::isfinite(step)) return;
  pull_springs(step);
  for (std::size_t hand = 0; hand < hands_; ++hand) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      Push& push = push_of(hand, i);
      push.power = push.f_W.dot(members_[i].motion.velocity_at(push.p_W));
      push.arm_W = push.p_W - members_[i].motion.body().p_WC();
    }
  }
  for (std::size_t i = 0; i < members_.size(); ++i) {
    members_[i].motion.body().load(loads_[i].f_W, loads_[i].tau_W);
    courses_[i].sum.f_W += loads_[i].f_W;
    courses_[i].sum.tau_W += loads_[i].tau_W;
  }
  if (phase_ == 0) solve(static_cast<double>(every_) * step);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    SolverState& state = states_[i];
    RigidMotion& motion = members_[i].motion;
    if (!state.met) {
      motion.step(step);
    } else if (every_ == 1) {
      motion.place(state.p_WC, state.q_WB, state.v_W, state.omega_W);
    } else {
      follow_course(i, step);
    }
    loads_[i] = {};
  }
  phase_ = (phase_ + 1) % every_;
  for (std::size_t hand = 0; hand < hands_; ++hand) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      Push& push = push_of(hand, i);
      const SolverState& state = states_[i];
      const double after = push.f_W.dot(members_[i].motion.velocity_at(push.p_W));
      const double power = state.met ? push.f_W.dot(state.way_W + state.turn_W.cross(push.arm_W))
                                     : (push.power + after) / 2;
      given_[hand] += step * power;
      push = {};
    }
  }
  double lost = first_ - energy();
  for (const double given : given_) lost += given;
  lost_ = std::max(lost_, lost);
}

Vector3d CollisionWorld::momentum_W() const noexcept {
  Vector3d sum = Vector3d::Zero();
  for (const Member& member : members_) sum += member.motion.body().momentum_W();
  return sum;
}

Vector3d CollisionWorld::angular_momentum_W() const noexcept {
  Vector3d sum = Vector3d::Zero();
  for (const Member& member : members_) {
    const RigidBody& body = member.motion.body();
    sum += body.angular_momentum_W() + body.p_WC().cross(body.momentum_W());
  }
  return sum;
}

}  // namespace thimble::render
