#pragma once

#include <string>

#include "thimble/scene/arm_file.h"

namespace thimble::ros2 {

/// Returns an arm as a URDF, which ROS 2 shows and computes with: its base stands in `world_frame`
/// as the arm file says, and its joints are those of the topic joint_states (joint1, joint2,
/// joint3, rad).
///
/// A serial arm is whole: yaw, both links, tip. Its second link is turned against the ground by a
/// parallelogram, so a joint that mimics the first link's stands between them. Of a linkage the yaw
/// and both bars are drawn, not the forearm, whose angle is no joint's; of all other arms the base
/// alone. Links have no mass but the tip, which has that with which the arm answers at its tip.
/// Names of links begin with the name of the arm's file, so that they meet no frame of /tf, and
/// before it with `name_in_scene`, if that is not empty: two arms of one kind have links of their
/// own. Lengths in m, masses in kg, effort in N m. Real-time: never from the servo thread.
std::string arm_urdf(const scene::ArmFile& arm, const std::string& world_frame,
                     const std::string& name_in_scene = {});

}  // namespace thimble::ros2
