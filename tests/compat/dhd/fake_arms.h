#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "compat/core/arm_access.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::compat::fake {

// Arms in place of those of `thimble exec`, for tests of a face alone: a mass in a viscous hand
// behind the driver's own safety gate, in time that passes only while somebody waits for a tick.

/// How the arms are made anew.
struct Setup {
  int arms = 2;                 ///< How many.
  bool has_orientation = true;  ///< And a gimbal.
  bool has_gripper = true;      ///< That can be measured.
  bool has_joints = true;       ///< With `jacobian`.
  bool held = true;             ///< The tip stays where it is, whatever the force.
};

/// Closes all arms and begins anew.
void reset(const Setup& setup = {});
/// Changes what an arm tells, and where it is.
void change(int arm, const std::function<void(ArmReading&)>& how);
/// Lets time pass in which nobody asks for a force, s.
void pass(int arm, double seconds);
/// Returns the force that the motors have, N in the world.
Eigen::Vector3d f_sent_W(int arm);
/// Returns what was asked last.
ForceAsked asked(int arm);
/// Returns the gate of an arm.
driver::Fault fault(int arm);
/// Ends the run, as `thimble exec` does.
void end_run();
/// Returns the functions that were called wrongly, in their order.
std::vector<std::string> wrong_calls();
/// Returns the Jacobian of all arms, m/rad.
Eigen::Matrix3d jacobian();

}  // namespace thimble::compat::fake
