#pragma once

#include <Eigen/Core>
#include <mutex>
#include <string>
#include <vector>

#include "support/pose_arm.h"

namespace thimble::support {

/// A library that stands in for Force Dimension's and is strict: whatever is called out of order,
/// with another arm's number, or after the end, it notes. Its arm is a mass on a hand. It is a
/// shared object of its own (mock_dhd.cpp), which tests find by `mock_dhd`.
struct MockDhd {
  std::mutex mutex;
  PoseArm arm;
  int arms = 1;             ///< That it finds.
  bool initialised = true;  ///< The arm knows its zero.
  bool wrist = false, gripper = false;
  bool held = false;       ///< Another program has it.
  std::string fails;       ///< The function that fails from now on.
  bool tells_nan = false;  ///< Positions are NaN.
  bool late = false;       ///< Exchanges take 60 ms.

  bool open = false, watchdog = false, gravity = false, brakes = true, force_on = false;
  bool expert = false;      ///< Functions of experts are allowed.
  bool tripped = false;     ///< The arm switched the forces off by itself.
  bool asked_zero = false;  ///< Somebody asked whether the arm knows its zero, since it was opened.
  int opened = 0, closed = 0, stopped = 0, found_zero = 0;
  std::vector<Eigen::Vector3d> taken;  ///< Forces, N.
  std::vector<std::string> wrong;      ///< What was called out of order.

  /// Begins anew.
  void reset() {
    const std::lock_guard lock(mutex);
    arm = PoseArm();
    arms = 1;
    initialised = true;
    wrist = gripper = held = tells_nan = late = expert = tripped = false;
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
