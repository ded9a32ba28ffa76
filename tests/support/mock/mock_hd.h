#pragma once

#include <Eigen/Core>
#include <mutex>
#include <string>
#include <vector>

#include "support/pose_arm.h"

namespace thimble::support {

/// A strict replacement of OpenHaptics' library, which records every call out of order. Its
/// scheduler is a separate thread at 1 kHz; its arm is a mass on a hand. It is a separate shared
/// object (mock_hd.cpp), which tests reach through `mock_hd`.
struct MockHd {
  std::mutex mutex;
  PoseArm arm;        ///< In m.
  bool there = true;  ///< A device is present.
  bool calibrated = true;
  int styles = 4;            ///< Of calibration; 4: inkwell.
  double nominal = 3.3;      ///< N
  unsigned error = 0;        ///< Error at the end of each frame.
  bool reports_nan = false;  ///< Positions are NaN.
  bool late = false;         ///< The scheduler runs every 60 ms.

  bool open = false, frame = false, scheduler = false, force_on = false, asked_calibration = false;
  int opened = 0, closed = 0, frames = 0, calibrations = 0;
  unsigned pending_error = 0;
  std::vector<Eigen::Vector3d> taken;  ///< Forces, N.
  std::vector<std::string> wrong;      ///< Calls out of order.

  /// Resets the mock. Precondition: no scheduler runs.
  void reset() {
    const std::lock_guard lock(mutex);
    arm = PoseArm();
    there = calibrated = true;
    styles = 4;
    nominal = 3.3;
    error = pending_error = 0;
    reports_nan = late = open = frame = scheduler = force_on = asked_calibration = false;
    opened = closed = frames = calibrations = 0;
    taken.clear();
    wrong.clear();
  }
};

}  // namespace thimble::support

extern "C" thimble::support::MockHd* mock_hd();
