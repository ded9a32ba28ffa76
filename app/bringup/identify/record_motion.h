#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "bringup/bench_arm.h"
#include "bringup/identify/arm_motion.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

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

/// Returns up to nine places (world, m) of a serial arm to move about: the middle of its workspace,
/// then towards the corners of it, opposite ones by turns, as far as excitation and reach leave
/// room. Real-time: never from the servo thread.
std::vector<Eigen::Vector3d> places_in(const scene::ArmFile& file, int count);

/// Returns whether a serial arm at a place (world, m) is far from stretched, folded and its yaw
/// axis, where it moves easily in all directions. Real-time: never from the servo thread.
bool moves_easily(const scene::ArmFile& file, const Eigen::Vector3d& p_W);

/// Records a motion about each of several places (world, m), to which the arm's own motors lead the
/// tip straight and slowly, with no more force, and leads it back to the first. Fails as
/// `record_motion` does; motors are not probed, `order.share` has what that found. Real-time: never
/// from the servo thread.
driver::Result<std::vector<ArmMotion>> record_places(BenchArm& bench, const scene::ArmFile& file,
                                                     const MotionOrder& order,
                                                     const std::vector<Eigen::Vector3d>& places_W,
                                                     const std::atomic<bool>& stop);

}  // namespace thimble::bringup
