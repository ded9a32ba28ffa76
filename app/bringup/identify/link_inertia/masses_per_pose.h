#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "bringup/identify/link_inertia/link_fit.h"
#include "thimble/scene/arm_file.h"

namespace thimble::bringup {

/// Apparent mass of the tip at a pose.
struct PoseMass {
  Eigen::Vector3d p_W{0, 0, 0};  ///< m
  std::array<Estimate, 3> mass;  ///< From the constants, along x, y and z of the base, kg.
  std::array<Estimate, 3> seen;  ///< From the motion there only, kg.
};

/// Returns the masses at the poses of the motions. Real-time: never from the servo thread.
std::vector<PoseMass> pose_masses(const LinkFit& fit, const scene::ArmFile& file);

/// Returns the apparent mass in a serial arm's file at joint angles q (rad), along x, y and z of
/// the base, kg. Real-time: never from the servo thread.
std::array<double, 3> named_masses(const scene::ArmFile& file, const Eigen::Vector3d& q);

/// Min. and max. apparent mass over the poses of the workspace where the arm moves easily
/// (`moves_easily`), on a grid of 1/8 of its extent, kg.
struct MassRange {
  Estimate min_mass, max_mass;
};
MassRange mass_range(const LinkFit& fit, const scene::ArmFile& file);

/// Returns that range as a sentence.
std::string range_text(const LinkFit& fit, const scene::ArmFile& file);

/// Returns all as a table for users.
std::string pose_table(const LinkFit& fit, const scene::ArmFile& file);

}  // namespace thimble::bringup
