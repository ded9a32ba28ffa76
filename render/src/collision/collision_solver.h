#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "collision/collider.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/joint_choice.h"
#include "thimble/render/body/motion_choice.h"

namespace thimble::render {

/// A body as the solver knows it. Its frame B has the origin in the centre of mass and axes along
/// the principal ones.
struct SolverBody {
  double mass = 1;                   ///< kg
  Eigen::Vector3d inertia{1, 1, 1};  ///< kg m^2 about the axes of B
  bool turns = true;                 ///< False: its orientation never changes.
  ColliderSet shape_B;               ///< In B, m.
  std::optional<Floor> floor{};      ///< Floor that only this body meets.
};

/// A joint between bodies: `a` and `b` are numbers of bodies, -1 for the world.
struct SolverJoint {
  JointChoice choice;
  int a = -1;
  int b = -1;
};

/// What a solver is built from. The bodies are at their first places then.
struct SolverPlan {
  std::vector<SolverBody> bodies;
  std::vector<ColliderSet> fixed_W;  ///< Objects that never move, in W.
  std::vector<SolverJoint> joints;   ///< All but springs.
  CollisionQuality quality;
  double step = 1e-3;  ///< s, of the loop
};

/// State of a body before and after a step: C is its centre of mass. W, SI units.
struct SolverState {
  Eigen::Vector3d p_WC{0, 0, 0};
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_W{0, 0, 0};
  Eigen::Vector3d omega_W{0, 0, 0};
  Eigen::Vector3d f_W{0, 0, 0};    ///< Sum of all forces but those of contacts and joints, N.
  Eigen::Vector3d tau_W{0, 0, 0};  ///< Their torque about C, N m.
  /// Set by the step: velocities with which the body moved during it. Those after it differ where
  /// it rebounded.
  Eigen::Vector3d way_W{0, 0, 0};
  Eigen::Vector3d turn_W{0, 0, 0};
  bool met = false;  ///< Set by the step: whether the body touched something or has a joint.
};

/// Two objects that overlap.
struct SolverOverlap {
  int body = -1;
  int other = -1;    ///< Number of a body; -1 if it never moves.
  int fixed = -1;    ///< Number of the object that never moves; -1 for a floor or a body.
  double depth = 0;  ///< m
};

/// Counts of a solver.
struct SolverCounters {
  std::uint64_t steps = 0;         ///< Steps.
  std::uint64_t contacts = 0;      ///< Points of contact with an impulse, over all steps.
  std::uint64_t contacts_max = 0;  ///< Largest number of them in one step.
};

/// Moves bodies that meet by one step: contacts without penetration, friction and joints.
class CollisionSolver {
 public:
  CollisionSolver() = default;
  CollisionSolver(const CollisionSolver&) = delete;
  CollisionSolver& operator=(const CollisionSolver&) = delete;
  virtual ~CollisionSolver() = default;

  /// Advances all bodies by `step` s. The result of a body that is not `met` is not to be used: it
  /// flies as without a solver. Real-time: no lock; memory is allocated when there are more groups
  /// of touching bodies than in any step before.
  virtual void step(std::span<SolverState> bodies, double step) noexcept = 0;
  /// Returns the pairs that overlap before the first step, by more than a hundredth of the smaller
  /// one's radius of gyration, each once. Real-time: never from the servo thread.
  virtual std::vector<SolverOverlap> overlaps() = 0;
  /// Returns the counts. Real-time: safe.
  virtual const SolverCounters& counters() const noexcept = 0;
};

/// Builds a solver by Bullet 3 [Bullet]. The error states that this build has none
/// (THIMBLE_BULLET), or names a joint with invalid numbers. Real-time: never from the servo thread.
driver::Result<std::unique_ptr<CollisionSolver>> build_collision_solver(
    const SolverPlan& plan, std::span<const SolverState> first);

}  // namespace thimble::render
