#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"
#include "thimble/session/recording.h"

namespace thimble::twin {

/// What a recording tells of one tick. Frames: B base, T tip.
struct TwinSample {
  Eigen::Vector3d p_BT{0, 0, 0};  ///< Where the encoders said the tip was, m.
  /// d q / d p_BT there, rad/m: torques pull on the tip by `G^T tau`.
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  Eigen::Vector3d amperes{0, 0, 0};  ///< That were sent to the motors, and stand to the next tick.
  bool fresh = false;                ///< A new report told the position.
};

/// The motion of an arm that was recorded, with what its motors were sent.
struct TwinMotion {
  double dt = 0;                                       ///< s between ticks
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Rotation of the base in the world.
  /// Stretches without a missing tick, in which forces went out; none is shorter than kLead.
  std::vector<std::vector<TwinSample>> stretches;
  double step_error = 0;          ///< RMS that the encoders' steps leave of an axis, m.
  std::vector<std::string> told;  ///< What a person should know of the recording, a sentence each.

  /// What a twin's forces may be late by at the most, s: so much of a stretch comes before its
  /// first window.
  static constexpr double kLead = 0.025;
};

/// What of a recording is compared.
struct TwinSpan {
  double from = 0;      ///< s after its first tick.
  double until = 1e12;  ///< s
};

/// Finds the motion in a recording of the arm that a file describes. Fails if the recording is of
/// another arm, holds no force, is too short, or if the arm cannot be simulated.
/// Real-time: never from the servo thread.
driver::Result<TwinMotion> twin_motion(const session::Recording& recording,
                                       const scene::ArmFile& file, const TwinSpan& span = {});

}  // namespace thimble::twin
