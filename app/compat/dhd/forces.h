#pragma once

#include <Eigen/Core>

namespace thimble::compat::dhd {

struct OpenArm;

/// Requests a force on the hand (N, in the program's frame) and waits until a tick has taken it,
/// which paces the program's loop. Enables the force if the program never set it. Torque (N m) and
/// gripper (N) are counted in the report. Returns 0, DHD_MOTOR_SATURATED if the force exceeds the
/// arm's limit, or -1.
int send_force(const char* function, OpenArm& arm, const Eigen::Vector3d& f_U,
               const Eigen::Vector3d& torque_U, double gripper) noexcept;

}  // namespace thimble::compat::dhd
