#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "body/motion/body_frame.h"
#include "body/motion/body_motions.h"
#include "body/motion/shared_body.h"
#include "collision/collider_of.h"
#include "collision/collision_solver.h"
#include "thimble/driver/result.h"

namespace thimble::render {

/// A spring between two bodies, or a body and the world.
struct SpringJoint {
  int a = -1;  ///< Number of a body; -1: the world.
  int b = -1;
  Eigen::Vector3d p_A{0, 0, 0};  ///< Its ends in the frames of the meshes of `a` and `b`, m.
  Eigen::Vector3d p_B{0, 0, 0};
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N s/m
  double length = 0;     ///< m, at rest
};

/// Bodies that collide, with their joints, and the hands that push them.
///
/// A body that touches nothing moves by RigidBody, as without collisions: momentum and angular
/// momentum are kept to rounding. The step of a body that touches something, or has a joint, is
/// that of the solver.
class CollisionWorld final : public SharedBody {
 public:
  /// A body: its motion without collisions, and whether it turns.
  struct Member {
    RigidMotion motion;
    bool turns = true;
  };

  /// Takes the bodies and what they meet. `plan.bodies` and `members` are in the same order;
  /// `hands` push them. Errors as build_collision_solver. Real-time: never from the servo thread.
  static driver::Result<std::shared_ptr<CollisionWorld>> build(std::vector<Member> members,
                                                               const SolverPlan& plan,
                                                               std::vector<SpringJoint> springs,
                                                               std::size_t hands);

  // All of the following are Real-time: safe, except as CollisionSolver::step.

  /// Returns the motion of a body.
  const RigidMotion& motion(std::size_t body) const noexcept { return members_[body].motion; }
  /// Returns the velocity that a body's point gains per impulse given there, 1/kg.
  Eigen::Vector3d gain_at(std::size_t body, const Eigen::Vector3d& p_W,
                          const Eigen::Vector3d& impulse) const noexcept;
  /// Pushes a body with `f_W` (N) at `p_W` (m) during the next step; once per hand, body and step.
  void push(std::size_t hand, std::size_t body, const Eigen::Vector3d& f_W,
            const Eigen::Vector3d& p_W) noexcept;
  /// Returns the stored energy of a hand (J), as SharedBodyOf::energy_for, of all bodies together.
  double energy_for(std::size_t hand) const noexcept;
  /// Returns the energy of motion, height and springs of all bodies, J.
  double energy() const noexcept;
  /// Notes that the force law of one body has ended its tick. If there is one hand, the last one
  /// steps the world.
  void end_of_body(double step) noexcept;

  void step(double step) noexcept override;
  Eigen::Vector3d momentum_W() const noexcept override;
  /// Returns the angular momentum of all bodies about the origin of W, kg m^2/s.
  Eigen::Vector3d angular_momentum_W() const noexcept override;

  std::size_t hands() const noexcept { return hands_; }
  std::size_t size() const noexcept { return members_.size(); }
  const CollisionSolver& solver() const noexcept { return *solver_; }
  CollisionSolver& solver() noexcept { return *solver_; }

 private:
  /// Push of a hand on a body in this tick.
  struct Push {
    Eigen::Vector3d f_W{0, 0, 0};
    Eigen::Vector3d p_W{0, 0, 0};
    Eigen::Vector3d arm_W{0, 0, 0};  // from the centre of mass
    double power = 0;                // W, before the step
  };

  CollisionWorld() = default;
  /// Force and torque about the centre of mass, N and N m.
  struct Load {
    Eigen::Vector3d f_W{0, 0, 0};
    Eigen::Vector3d tau_W{0, 0, 0};
  };
  /// Way of a body that met something, between two steps of the solver.
  struct Course {
    Eigen::Vector3d v_W{0, 0, 0};  // mean velocities that lead to the solver's result
    Eigen::Vector3d omega_W{0, 0, 0};
    Load assumed{};                     // by the solver
    Load sum{};                         // of all ticks since the last step of the solver
    Eigen::Vector3d more_v_W{0, 0, 0};  // velocities by loads other than assumed
    Eigen::Vector3d more_omega_W{0, 0, 0};
  };
  void pull_springs(double step) noexcept;
  void solve(double step) noexcept;
  void follow_course(std::size_t body, double step) noexcept;
  void push_at(std::size_t body, const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_W) noexcept;
  Push& push_of(std::size_t hand, std::size_t body) noexcept {
    return pushes_[hand * members_.size() + body];
  }

  std::vector<Member> members_;
  std::unique_ptr<CollisionSolver> solver_;
  std::vector<SpringJoint> springs_;
  std::size_t hands_ = 1;
  std::vector<SolverState> states_;
  std::size_t every_ = 1;  // ticks in a step of the solver
  std::size_t phase_ = 0;  // ticks since then
  std::vector<Course> courses_;
  std::vector<Load> loads_;    // of each body in this tick: pushes and springs
  std::vector<Push> pushes_;   // of each hand and body
  std::vector<double> given_;  // work of each hand, J
  std::size_t ended_ = 0;      // bodies whose tick has ended
  double first_ = 0;           // energy before any step, J
  double lost_ = 0;            // largest loss of energy so far, J
};

/// Adds a body to the two lists of CollisionWorld::build. The error names an invalid number, or why
/// there is no shape. Real-time: never from the servo thread.
driver::Result<void> add_body(const SolidToCollide& solid, const CollisionChoice& collision,
                              MotionChoice choice, SolverPlan& plan,
                              std::vector<CollisionWorld::Member>& members);

/// Returns a spring with its ends in the frames of the meshes, which are W before the first tick.
SpringJoint spring_of(const JointChoice& choice, int a, int b);

}  // namespace thimble::render
