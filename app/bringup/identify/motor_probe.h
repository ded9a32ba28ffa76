#pragma once

#include <Eigen/Core>
#include <atomic>
#include <functional>

#include "bringup/bench_arm.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Pushes each joint briefly in both directions before any force follows the motion: a reversed
/// motor would drive the tip away. A push starts weak, doubles until the joint is seen to move, and
/// reverses before the tip has moved far. Returns the share of the requested torque for each motor,
/// at most 1. It prevents that a motor stronger than in the arm file causes a limit cycle under a
/// force that follows the motion. No push exceeds `max_force` (N). `within` returns whether a tip
/// (W, m) may be pushed there; otherwise no more force is requested. The error names a motor that
/// pulls in the wrong direction, or that moves nothing. Real-time: never from the servo thread.
driver::Result<Eigen::Vector3d> probe_motors(
    BenchArm& bench, const scene::ArmFile& file, double max_force,
    const std::function<bool(const Eigen::Vector3d&)>& within, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
