#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

// The laws apply to one direction; an arm has three at each pose. These values hold for all
// directions [PHYSICS 9]: the smallest eigenvalue of the damping at the tip for stiffness times
// latency, the largest step of the encoders, and the smallest apparent mass. The functions are here
// because app knows arm, hand and workspace. Real-time: none of these functions may be called from
// the servo thread.

/// Properties of an arm's tip in its worst directions, at one pose or over many.
struct TipLimits {
  double encoder_step = 0;  ///< Largest step of the tip, m.
  double damping = 0;       ///< Smallest eigenvalue of the damping, N s/m.
  double mass = 0;          ///< Smallest eigenvalue of the mass, kg.
};

/// Returns the largest step of the tip that an adversary can produce per unit displacement, m: the
/// largest row sum of |J| dq, `joint_steps` in rad.
///
/// Along a direction n the adversary crosses one edge of each encoder at once. The wall's force
/// jumps by K sum_k |J_k . n| dq_k along n, against dry friction of c (|n_x| + |n_y| + |n_z|). The
/// quotient is convex in n, so its maximum is at an axis, where it equals the row sum of that axis.
/// (The column sum is the step of one encoder; it is smaller if several encoders move the tip along
/// one axis.)
double tip_step(const Eigen::Matrix3d& J_BT, const Eigen::Vector3d& joint_steps);

/// Returns the worst directions of a linear arm at one pose, from mass and damping at its joints
/// (kg m^2, N m s): tip mass (J M^-1 J^T)^-1, tip damping J^-T C J^-1. Returns zeros for a pose in
/// which the arm cannot move in all directions.
TipLimits tip_limits(const Eigen::Matrix3d& J_BT, const Eigen::Matrix3d& mass,
                     const Eigen::Matrix3d& damping, const Eigen::Vector3d& joint_steps);

/// Returns the Jacobian of an arm of any geometry with its tip at a point of the world (m), in its
/// base, as computed by its driver. Empty if out of reach.
std::optional<Eigen::Matrix3d> jacobian_at(const ArmFile& arm, const Eigen::Vector3d& p_WT);

/// Returns the reachable points of a grid of `per_side`^3 points over the workspace, m, world.
THIMBLE_EXPORT std::vector<Eigen::Vector3d> points_of_workspace(const ArmFile& arm, int per_side);

/// Returns the worst directions over the workspace, from the arm file's values for the tip (the
/// same mass and friction in every direction) and the encoders; ideal encoders have no step.
THIMBLE_EXPORT TipLimits worst_over_workspace(const ArmFile& arm, int per_side = 7);

}  // namespace thimble::scene
