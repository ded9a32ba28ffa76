#pragma once

#include <utility>
#include <vector>

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Checks by zero force that the arm counts where its file says: a person brings it into its home
/// pose from two sides. An arm that got power elsewhere is seen by that, and so are cables that
/// slip.
HilResult check_home_pose(const HilRig& rig);

/// Checks by zero force that a movement is as long as it is: a person moves the tip by `length` (m)
/// along each axis of the world, from mark to mark. Motion and a known mass alone cannot tell the
/// scale of encoders and links.
HilResult check_known_length(const HilRig& rig, double length);

/// Returns a simulated hand that holds the tip firmly to a mark.
device_sim::HandSettings firm_hand();

/// Returns the way of a simulated hand that does what `check_home_pose` asks (seconds and points in
/// the world, m).
std::vector<std::pair<double, Eigen::Vector3d>> home_pose_hand(const scene::ArmFile& file);

/// Returns the way of a simulated hand that does what `check_known_length` asks.
std::vector<std::pair<double, Eigen::Vector3d>> known_length_hand(const scene::ArmFile& file,
                                                                  double length);

}  // namespace thimble::hil
