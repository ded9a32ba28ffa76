#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "bringup/bench_arm.h"
#include "bringup/identify/arm_motion.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Parameters of a motion.
struct MotionOrder {
  double seconds = 60;     ///< Recorded time, s.
  double lead = 1;         ///< Motion before it, s: soft start, and release of the tip by a user.
  double added_mass = 0;   ///< Mass fixed to the tip, kg.
  double max_force = 1;    ///< Max. requested force, N.
  std::uint64_t seed = 1;  ///< Seed of the excitation's phases.
  /// Share of the requested torque, for an arm with a mass on it: ArmMotion::share of its bare tip,
  /// which is probed instead.
  Eigen::Vector3d share{1, 1, 1};
};

/// Moves a free arm by an Excitation and records it. The device is idle before and after. Fails,
/// with zero force, if a motor pulls in the wrong direction, if the tip leaves its allowed space,
/// on a fault, or when `stop` is set. Motors are checked only without an added mass, which would
/// fall meanwhile. Real-time: never from the servo thread.
driver::Result<ArmMotion> record_motion(BenchArm& bench, const scene::ArmFile& file,
                                        const MotionOrder& order, const std::atomic<bool>& stop);

/// Returns up to nine points (world, m) of a serial arm to move about. The first is the middle of
/// its workspace. The others are towards its corners, opposite ones in turn, as far as excitation
/// and reach permit. Real-time: never from the servo thread.
std::vector<Eigen::Vector3d> sweep_points(const scene::ArmFile& file, int count);

/// Returns whether a serial arm at a point (world, m) is far from stretched, from folded and from
/// its yaw axis, where it moves easily in all directions. Real-time: never from the servo thread.
bool moves_easily(const scene::ArmFile& file, const Eigen::Vector3d& p_W);

/// Records a motion about each of several points (world, m). The arm's own motors lead the tip
/// there straight and slowly, with no more force, and lead it back to the first. Fails like
/// `record_motion`; motors are not probed, because `order.share` has the result of the probe.
/// Real-time: never from the servo thread.
driver::Result<std::vector<ArmMotion>> record_at_points(
    BenchArm& bench, const scene::ArmFile& file, const MotionOrder& order,
    const std::vector<Eigen::Vector3d>& places_W, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
