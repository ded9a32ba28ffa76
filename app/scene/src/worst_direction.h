#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

// The laws are for one direction; an arm has three at each pose. What holds in all of them
// [PHYSICS 9]: stiffness times latency up to the least eigenvalue of the damping at the tip, the
// longest step of the encoders, the least apparent mass. app knows arm, hand and workspace, so the
// rule is here. Real-time: never from the servo thread.

/// What an arm's tip is made of in its worst directions, at one pose or over many.
struct TipLimits {
  double encoder_step = 0;  ///< m
  double damping = 0;       ///< Least eigenvalue, N s/m.
  double mass = 0;          ///< Least eigenvalue, kg.
};

/// Finds the longest step of the tip that an adversary gets for one unit of way along it, m: the
/// largest row sum of |J| dq, `joint_steps` in rad.
///
/// Along a direction n he crosses one edge of each encoder at once, so the wall's force jumps by
/// K sum_k |J_k . n| dq_k along n, against dry friction of c (|n_x| + |n_y| + |n_z|). The quotient
/// is convex in n, so it is largest at an axis, where it is that axis' row sum. (The column sum is
/// the step of one encoder; it is shorter where several encoders move the tip along one axis.)
double tip_step(const Eigen::Matrix3d& J_BT, const Eigen::Vector3d& joint_steps);

/// Finds the worst directions of a linear arm at one pose, from mass and damping at its joints
/// (kg m^2, N m s): tip mass (J M^-1 J^T)^-1, tip damping J^-T C J^-1. A pose in which the arm
/// cannot move in all directions gives zeros.
TipLimits tip_limits(const Eigen::Matrix3d& J_BT, const Eigen::Matrix3d& mass,
                     const Eigen::Matrix3d& damping, const Eigen::Vector3d& joint_steps);

/// Finds the Jacobian of an arm of whatever build with its tip at a point of the world (m), in its
/// base, as its driver has it. Empty out of reach.
std::optional<Eigen::Matrix3d> jacobian_at(const ArmFile& arm, const Eigen::Vector3d& p_WT);

/// Returns a grid of `per_side`^3 points over the workspace, those that the arm reaches, m, world.
THIMBLE_EXPORT std::vector<Eigen::Vector3d> points_of_workspace(const ArmFile& arm, int per_side);

/// Finds the worst directions over the workspace, of what the arm's file says of its tip (the same
/// mass and friction in every direction) and of its encoders; ideal encoders have no step.
THIMBLE_EXPORT TipLimits worst_over_workspace(const ArmFile& arm, int per_side = 7);

}  // namespace thimble::scene
