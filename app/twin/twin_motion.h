#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"
#include "thimble/session/recording.h"

namespace thimble::twin {

/// Recorded data of one tick. Frames: B base, T tip.
struct TwinSample {
  Eigen::Vector3d p_BT{0, 0, 0};  ///< Tip position from the encoders, m.
  /// d q / d p_BT there, rad/m: torques exert the force `G^T tau` on the tip.
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  Eigen::Vector3d amperes{0, 0, 0};  ///< Currents sent to the motors, held to the next tick.
  bool fresh = false;                ///< The position is from a new report.
};

/// The recorded motion of an arm, with the currents of its motors.
struct TwinMotion {
  double dt = 0;                                       ///< s between ticks
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Rotation of the base in the world.
  /// Stretches without a missing tick, in which forces were sent; none is shorter than kLead.
  std::vector<std::vector<TwinSample>> stretches;
  double step_error = 0;  ///< RMS error of an axis that the encoders' steps cause, m.
  std::vector<std::string>
      messages;  ///< Messages about the recording for the user, a sentence each.

  /// Max. delay of a twin's forces, s: this part of a stretch precedes its first window.
  static constexpr double kLead = 0.025;
};

/// Compared part of a recording.
struct TwinSpan {
  double from = 0;      ///< s after its first tick.
  double until = 1e12;  ///< s
};

/// Extracts the motion from a recording of the arm that a file describes. Fails if the recording is
/// of another arm, holds no force or is too short, or if the arm cannot be simulated. Real-time:
/// never from the servo thread.
driver::Result<TwinMotion> twin_motion(const session::Recording& recording,
                                       const scene::ArmFile& file, const TwinSpan& span = {});

}  // namespace thimble::twin
