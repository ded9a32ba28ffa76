#pragma once

#include <Eigen/Core>
#include <mutex>
#include <string>
#include <vector>

#include "support/pose_arm.h"

namespace thimble::support {

/// A strict replacement of Force Dimension's library. It records every call out of order, with
/// another arm's number, or after the end. Its arm is a mass on a hand. It is a separate shared
/// object (mock_dhd.cpp), which tests reach through `mock_dhd`.
struct MockDhd {
  std::mutex mutex;
  PoseArm arm;
  int arms = 1;             ///< Number of arms found.
  bool initialised = true;  ///< The arm knows its zero.
  bool wrist = false, gripper = false;
  bool held = false;         ///< Another program uses it.
  std::string fails;         ///< The function that fails from now on.
  bool reports_nan = false;  ///< Positions are NaN.
  bool late = false;         ///< Exchanges take 60 ms.

  bool open = false, watchdog = false, gravity = false, brakes = true, force_on = false;
  bool expert = false;   ///< Expert functions are enabled.
  bool tripped = false;  ///< The arm has switched the forces off by itself.
  bool asked_zero =
      false;  ///< The caller has checked that the arm is initialised, since it was opened.
  int opened = 0, closed = 0, stopped = 0, found_zero = 0;
  std::vector<Eigen::Vector3d> taken;  ///< Forces, N.
  std::vector<std::string> wrong;      ///< Calls out of order.

  /// Resets the mock.
  void reset() {
    const std::lock_guard lock(mutex);
    arm = PoseArm();
    arms = 1;
    initialised = true;
    wrist = gripper = held = reports_nan = late = expert = tripped = false;
    fails.clear();
    open = watchdog = gravity = force_on = asked_zero = false;
    brakes = true;
    opened = closed = stopped = found_zero = 0;
    taken.clear();
    wrong.clear();
  }
};

}  // namespace thimble::support

extern "C" thimble::support::MockDhd* mock_dhd();
