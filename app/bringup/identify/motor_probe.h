#pragma once

#include <Eigen/Core>
#include <atomic>
#include <functional>

#include "bringup/bench_arm.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Pushes each joint to and fro for an instant, before any force follows the motion: one whose
/// motor is turned round would drive the tip away. A push begins weak and doubles until the joint
/// is seen to move, and turns round before the tip has gone far. Returns which share of the torque
/// that is asked for each motor shall be given, 1 at the most, so that a motor which is stronger
/// than the arm file says makes no limit cycle of a force that follows the motion. No push is above
/// `force_most` (N). `within` says
/// whether a tip (W, m) is where it may be pushed; where it is not, no force is asked for any more.
/// The error names a motor that pulls the wrong way, or that moves nothing. Real-time: never from
/// the servo thread.
driver::Result<Eigen::Vector3d> probe_motors(
    BenchArm& bench, const scene::ArmFile& file, double force_most,
    const std::function<bool(const Eigen::Vector3d&)>& within, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
