// Joints and encoders.
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "compat/dhd/forces.h"
#include "compat/dhd/last_error.h"
#include "compat/dhd/open_arms.h"
#include "drdc.h"

using namespace thimble::compat;
using namespace thimble::compat::dhd;

namespace {

// A pose counts as singular if the Jacobian's determinant is below this fraction of its largest
// possible value: torques then correspond to no force [chosen].
constexpr double kSingular = 1e-6;
// Angles that differ by less from the arm's current ones are treated as equal, rad [chosen: below
// any encoder's step].
constexpr double kSameAngle = 1e-4;

// Returns the arm with joints that `id` names, and its last state. If there is none, or a pointer
// is null, returns null and records an error.
OpenArm* arm_with_joints(const char* function, char id, bool pointers,
                         ArmReading& reading) noexcept {
  OpenArm* arm = open_arm(function, id);
  if (!arm) return nullptr;
  if (!pointers) {
    fail(function, DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
    return nullptr;
  }
  if (!arms::facts(arm->number).has_joints) {
    fail(function, DHD_ERROR_NOT_AVAILABLE, "the joints of this arm are unknown");
    return nullptr;
  }
  return read_arm(function, *arm, reading) ? arm : nullptr;
}

bool solvable(const Eigen::Matrix3d& J) noexcept {
  const double max_determinant = J.col(0).norm() * J.col(1).norm() * J.col(2).norm();
  return std::abs(J.determinant()) > kSingular * max_determinant;
}

// Returns whether joint angles are those of a state.
bool same_angles(const double* angles, const ArmReading& reading) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(std::abs(angles[i] - reading.q[i]) < kSameAngle)) return false;
  }
  return true;
}

// Finds the Jacobian in the world at joint angles; otherwise returns false and records an error.
bool find_jacobian(const char* function, const OpenArm& arm, const double* angles,
                   const ArmReading& reading, Eigen::Matrix3d& J) noexcept {
  std::array<double, 9> rows = reading.J_WT;
  const bool known = same_angles(angles, reading) ||
                     arms::jacobian_at(arm.number, {angles[0], angles[1], angles[2]}, rows);
  J = matrix_of(rows);
  if (!known) fail(function, DHD_ERROR_GEOMETRY, "the arm cannot have these joint angles");
  return known;
}

int not_available(const char* function, char id, const char* what) noexcept {
  return open_arm(function, id) ? fail(function, DHD_ERROR_NOT_AVAILABLE, what) : -1;
}

}  // namespace

extern "C" {

int dhdGetEnc(int* counts, unsigned char mask, char id) {
  ArmReading reading;
  if (!arm_with_joints("dhdGetEnc", id, counts, reading)) return -1;
  for (int i = 0; i < DHD_MAX_DOF; ++i) {
    if ((mask >> i) & 1) counts[i] = i < 3 ? reading.counts[static_cast<std::size_t>(i)] : 0;
  }
  return 0;
}

int dhdGetJointAngles(double* angles, char id) {
  ArmReading reading;
  if (!arm_with_joints("dhdGetJointAngles", id, angles, reading)) return -1;
  std::fill_n(angles, DHD_MAX_DOF, 0.0);
  std::copy_n(reading.q.begin(), 3, angles);
  std::copy_n(reading.gimbal.begin(), 3, angles + 3);
  return 0;
}

int dhdGetDeltaEncoders(int* first, int* second, int* third, char id) {
  ArmReading reading;
  if (!arm_with_joints("dhdGetDeltaEncoders", id, first && second && third, reading)) return -1;
  *first = reading.counts[0], *second = reading.counts[1], *third = reading.counts[2];
  return 0;
}

int dhdGetDeltaJointAngles(double* first, double* second, double* third, char id) {
  ArmReading reading;
  if (!arm_with_joints("dhdGetDeltaJointAngles", id, first && second && third, reading)) return -1;
  *first = reading.q[0], *second = reading.q[1], *third = reading.q[2];
  return 0;
}

int dhdGetWristJointAngles(double* first, double* second, double* third, char id) {
  constexpr const char* kFunction = "dhdGetWristJointAngles";
  ArmReading reading;
  const OpenArm* arm = arm_with_joints(kFunction, id, first && second && third, reading);
  if (!arm) return -1;
  if (!arms::facts(arm->number).has_gimbal) {
    return fail(kFunction, DHD_ERROR_NOT_AVAILABLE, "the arm does not measure its wrist");
  }
  *first = static_cast<double>(reading.gimbal[0]);
  *second = static_cast<double>(reading.gimbal[1]);
  *third = static_cast<double>(reading.gimbal[2]);
  return 0;
}

int dhdDeltaJointAnglesToJacobian(double first, double second, double third, double rows[3][3],
                                  char id) {
  constexpr const char* kFunction = "dhdDeltaJointAnglesToJacobian";
  ArmReading reading;
  const OpenArm* arm = arm_with_joints(kFunction, id, rows, reading);
  if (!arm) return -1;
  const std::array<double, 3> angles{first, second, third};
  Eigen::Matrix3d J;
  if (!find_jacobian(kFunction, *arm, angles.data(), reading, J)) return -1;
  J = user_rotation(*arm) * J;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows[i][j] = J(i, j);
  }
  return 0;
}

int dhdGetJointVelocities(double* velocities, char id) {
  ArmReading reading;
  if (!arm_with_joints("dhdGetJointVelocities", id, velocities, reading)) return -1;
  const Eigen::Matrix3d J = matrix_of(reading.J_WT);
  if (!solvable(J)) {
    return fail("dhdGetJointVelocities", DHD_ERROR_GEOMETRY, "the arm is in a singular pose");
  }
  const Eigen::Vector3d speeds = J.partialPivLu().solve(vector_of(reading.v_WT));
  std::fill_n(velocities, DHD_MAX_DOF, 0.0);
  for (int i = 0; i < 3; ++i) velocities[i] = speeds[i];
  return 0;
}

int dhdGetDeltaJacobian(double rows[3][3], char id) {
  ArmReading reading;
  const OpenArm* arm = arm_with_joints("dhdGetDeltaJacobian", id, rows, reading);
  if (!arm) return -1;
  const Eigen::Matrix3d J = user_rotation(*arm) * matrix_of(reading.J_WT);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows[i][j] = J(i, j);
  }
  return 0;
}

int dhdSetJointTorques(double* torques, unsigned char mask, char id) {
  ArmReading reading;
  OpenArm* arm = arm_with_joints("dhdSetJointTorques", id, torques, reading);
  if (!arm) return -1;
  if (!expert_mode()) {
    return fail("dhdSetJointTorques", DHD_ERROR_EXPERT_MODE_DISABLED, "expert mode is off");
  }
  if (arm->regulator.running()) {
    return fail("dhdSetJointTorques", DHD_ERROR_DEVICE_IN_USE, "the arm is regulated");
  }
  const Eigen::Matrix3d J = matrix_of(reading.J_WT);
  if (!solvable(J)) {
    return fail("dhdSetJointTorques", DHD_ERROR_GEOMETRY, "the arm is in a singular pose");
  }
  Eigen::Vector3d tau{0, 0, 0};
  for (int i = 0; i < 3; ++i) {
    if ((mask >> i) & 1) tau[i] = torques[i];
  }
  // tau = J^T f: converts torques to the equivalent force at the tip, so that the gate checks
  // everything that moves the arm.
  const Eigen::Vector3d f_W = J.transpose().partialPivLu().solve(tau);
  return send_force("dhdSetJointTorques", *arm, user_rotation(*arm) * f_W, {0, 0, 0}, 0);
}

int dhdGetEncVelocities(double*, char id) {
  return not_available("dhdGetEncVelocities", id, "not available; use dhdGetJointVelocities");
}
int dhdWristJointAnglesToJacobian(double, double, double, double (*)[3], char id) {
  return not_available("dhdWristJointAnglesToJacobian", id, "the wrist has no motors");
}
int dhdGetWristJacobian(double (*)[3], char id) {
  return not_available("dhdGetWristJacobian", id, "the wrist has no motors");
}
int dhdGetJointAngleRange(double*, double*, char id) {
  return not_available("dhdGetJointAngleRange", id,
                       "arm files have a workspace, but no joint ranges");
}

int dhdJointAnglesToInertiaMatrix(double* angles, double rows[6][6], char id) {
  constexpr const char* kFunction = "dhdJointAnglesToInertiaMatrix";
  ArmReading reading;
  const OpenArm* arm = arm_with_joints(kFunction, id, angles && rows, reading);
  if (!arm) return -1;
  const double mass = arm->effector_mass;
  if (!(mass > 0))
    return fail(kFunction, DHD_ERROR_NOT_AVAILABLE,
                "the inertia is unknown; set a mass with dhdSetEffectorMass");
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) rows[i][j] = i == j && i < 3 ? mass : 0;
  }
  return 0;
}

int dhdJointAnglesToGravityJointTorques(double* angles, double* torques, unsigned char mask,
                                        char id) {
  constexpr const char* kFunction = "dhdJointAnglesToGravityJointTorques";
  constexpr double kGravity = 9.80665;  // m/s^2, standard gravity
  ArmReading reading;
  const OpenArm* arm = arm_with_joints(kFunction, id, angles && torques, reading);
  if (!arm) return -1;
  const double mass = arm->effector_mass;
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  if (mass > 0 && !find_jacobian(kFunction, *arm, angles, reading, J)) return -1;
  const Eigen::Vector3d tau = J.transpose() * Eigen::Vector3d(0, 0, mass * kGravity);
  for (int i = 0; i < DHD_MAX_DOF; ++i) {
    if ((mask >> i) & 1) torques[i] = i < 3 ? tau[i] : 0;
  }
  return 0;
}

}  // extern "C"
