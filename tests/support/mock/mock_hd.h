#pragma once

#include <Eigen/Core>
#include <mutex>
#include <string>
#include <vector>

#include "support/pose_arm.h"

namespace thimble::support {

/// A library that stands in for OpenHaptics' and is strict: whatever is called out of order, it
/// notes. Its scheduler is a thread of its own at 1 kHz; its arm is a mass on a hand. It is a
/// shared object of its own (mock_hd.cpp), which tests find by `mock_hd`.
struct MockHd {
  std::mutex mutex;
  PoseArm arm;        ///< In m.
  bool there = true;  ///< A device answers.
  bool calibrated = true;
  int styles = 4;          ///< Of calibration; 4: inkwell.
  double nominal = 3.3;    ///< N
  unsigned error = 0;      ///< That each frame ends with.
  bool tells_nan = false;  ///< Positions are NaN.
  bool late = false;       ///< The scheduler turns every 60 ms.

  bool open = false, frame = false, scheduler = false, force_on = false, asked_calibration = false;
  int opened = 0, closed = 0, frames = 0, calibrations = 0;
  unsigned pending_error = 0;
  std::vector<Eigen::Vector3d> taken;  ///< Forces, N.
  std::vector<std::string> wrong;      ///< What was called out of order.

  /// Begins anew. Precondition: no scheduler runs.
  void reset() {
    const std::lock_guard lock(mutex);
    arm = PoseArm();
    there = calibrated = true;
    styles = 4;
    nominal = 3.3;
    error = pending_error = 0;
    tells_nan = late = open = frame = scheduler = force_on = asked_calibration = false;
    opened = closed = frames = calibrations = 0;
    taken.clear();
    wrong.clear();
  }
};

}  // namespace thimble::support

extern "C" thimble::support::MockHd* mock_hd();
