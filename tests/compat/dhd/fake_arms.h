#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "compat/core/arm_access.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::compat::fake {

// Fake arms instead of those of `thimble exec`, to test a compatibility library without a server: a
// mass in a viscous hand behind the driver's safety gate. Time advances only while a thread waits
// for a tick.

/// Options of the fake arms.
struct Setup {
  int arms = 2;                 ///< Number of arms.
  bool has_orientation = true;  ///< They measure the stylus and its gimbal.
  bool has_gripper = true;      ///< They measure a gripper.
  bool has_joints = true;       ///< They have joints, with `jacobian`.
  bool held = true;             ///< No force moves the tip.
  bool simulated = true;        ///< No real motors.
  int taken = -1;               ///< Number of an arm that another program has open; -1: none.
};

/// Closes all arms and makes new ones.
void reset(const Setup& setup = {});
/// Changes the state of an arm.
void change(int arm, const std::function<void(ArmReading&)>& how);
/// Advances the time by `seconds` without a requested force.
void pass(int arm, double seconds);
/// Returns the force of the motors, N in the world.
Eigen::Vector3d f_sent_W(int arm);
/// Returns the last request.
ForceRequest asked(int arm);
/// Returns the fault of an arm's gate.
driver::Fault fault(int arm);
/// Returns whether the program moves the tip (arms::set_regulated).
bool regulated(int arm);
/// Ends the run, as `thimble exec` does.
void end_run();
/// Returns the functions that were called wrongly, in order.
std::vector<std::string> wrong_calls();
/// Returns the Jacobian of all arms, m/rad.
Eigen::Matrix3d jacobian();

}  // namespace thimble::compat::fake
