#pragma once

#include <atomic>
#include <cstdint>

#include "bringup/bench_arm.h"
#include "bringup/identify/arm_motion.h"
#include "thimble/driver/result.h"

namespace thimble::app {

/// What motion is asked for.
struct MotionOrder {
  double seconds = 60;     ///< That are recorded.
  double lead = 1;         ///< That it moves before, s: soft start, and a person who lets go.
  double added_mass = 0;   ///< That is fixed to the tip, kg.
  double force_most = 1;   ///< The most that is asked for, N.
  std::uint64_t seed = 1;  ///< Of the excitation's phases.
  /// Of the torque that is asked for, for an arm with a mass on it: ArmMotion::share of its bare
  /// tip, which is probed instead.
  Eigen::Vector3d share{1, 1, 1};
};

/// Moves a free arm by an Excitation and records it. The device is idle before and after. Fails,
/// with zero force, if a motor pulls the wrong way, if the tip leaves the space it may move in, on
/// a fault, or when `stop` is set. Motors are checked without an added mass alone, which falls
/// meanwhile. Real-time: never from the servo thread.
driver::Result<ArmMotion> record_motion(BenchArm& bench, const scene::ArmFile& file,
                                        const MotionOrder& order, const std::atomic<bool>& stop);

}  // namespace thimble::app
