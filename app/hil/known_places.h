#pragma once

#include <utility>
#include <vector>

#include "hil/hil_rig.h"

namespace thimble::hil {

/// Checks with zero force that the arm's zero is that of its file: a user brings it to its home
/// pose from two sides. This detects an arm that was switched on in another pose, and slipping
/// cables.
HilResult check_home_pose(const HilRig& rig);

/// Checks with zero force the scale of a movement: a user moves the tip by `length` (m) along each
/// axis of the world, from mark to mark. Motion and a known mass do not determine the scale of
/// encoders and links.
HilResult check_known_length(const HilRig& rig, double length);

/// Returns a simulated hand that holds the tip firmly at a mark.
device_sim::HandSettings firm_hand();

/// Returns the path of a simulated hand for `check_home_pose` (seconds and points in the world, m).
std::vector<std::pair<double, Eigen::Vector3d>> home_pose_hand(const scene::ArmFile& file);

/// Returns the path of a simulated hand for `check_known_length`.
std::vector<std::pair<double, Eigen::Vector3d>> known_length_hand(const scene::ArmFile& file,
                                                                  double length);

}  // namespace thimble::hil
