#pragma once

#include <string>

#include "thimble/scene/arm_file.h"

namespace thimble::ros2 {

/// Returns an arm as a URDF, for display and computation in ROS 2. Its base has the pose in
/// `world_frame` that the arm file gives. Its joints are those of the topic joint_states (joint1,
/// joint2, joint3, rad).
///
/// A serial arm is complete: yaw, both links, tip. A parallelogram keeps the angle of its second
/// link relative to the ground, so a joint that mimics the first link's is added between them. Of a
/// linkage, the yaw and both bars are drawn, but not the forearm, whose angle is that of no joint.
/// Of a five-bar, both cranks are drawn, but not the distal bars. Of all other arms only the base
/// is drawn. Links have no mass except the tip, which has the arm's effective mass at its tip.
/// Names of links begin with the name of the arm's file, so that they differ from other frames of
/// /tf. If `name_in_scene` is not empty, it comes first, so that two arms of one kind have
/// different links. Lengths in m, masses in kg, effort in N m. Real-time: never from the servo
/// thread.
std::string arm_urdf(const scene::ArmFile& arm, const std::string& world_frame,
                     const std::string& name_in_scene = {});

}  // namespace thimble::ros2
