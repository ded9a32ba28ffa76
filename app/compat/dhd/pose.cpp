// Position, orientation and velocity of an arm's tip.
#include <numbers>

#include "compat/dhd/euler_angles.h"
#include "compat/dhd/last_error.h"
#include "compat/dhd/open_arms.h"
#include "drdc.h"

using namespace thimble::compat;
using namespace thimble::compat::dhd;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

// State of an arm in the program's frame U.
struct Pose {
  Eigen::Vector3d p_UT, v_UT, w_UT;
  Eigen::Matrix3d R_UT;
};

template <class... Pointers>
bool none_null(const char* function, const Pointers*... pointers) noexcept {
  if ((pointers && ...)) return true;
  fail(function, DHD_ERROR_NULL_ARGUMENT, "a pointer is null");
  return false;
}

bool pose_of(const char* function, char id, Pose& pose) noexcept {
  const OpenArm* arm = open_arm(function, id);
  ArmReading reading;
  if (!arm || !read_arm(function, *arm, reading)) return false;
  const Eigen::Matrix3d R_UW = user_rotation(*arm);
  pose.p_UT = R_UW * vector_of(reading.p_WT);
  pose.v_UT = R_UW * vector_of(reading.v_WT);
  pose.w_UT = R_UW * vector_of(reading.w_WT);
  pose.R_UT = R_UW * matrix_of(reading.R_WT);
  return true;
}

void put(const Eigen::Vector3d& v, double* x, double* y, double* z) noexcept {
  *x = v.x(), *y = v.y(), *z = v.z();
}

void put(const Eigen::Matrix3d& R, double (*rows)[3]) noexcept {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows[i][j] = R(i, j);
  }
}

// Writes a vector of a pose, or a value derived from it.
template <class Part>
int put_part(const char* function, char id, double* x, double* y, double* z, Part part) noexcept {
  Pose pose;
  if (!open_arm(function, id) || !none_null(function, x, y, z)) return -1;
  if (!pose_of(function, id, pose)) return -1;
  put(part(pose), x, y, z);
  return 0;
}

int put_pose(const char* function, char id, double unit, double* x, double* y, double* z, double* a,
             double* b, double* c) noexcept {
  Pose pose;
  if (!open_arm(function, id) || !none_null(function, x, y, z, a, b, c)) return -1;
  if (!pose_of(function, id, pose)) return -1;
  put(pose.p_UT, x, y, z);
  put(Eigen::Vector3d(euler_angles(pose.R_UT) / unit), a, b, c);
  return 0;
}

}  // namespace

extern "C" {

int dhdGetPosition(double* x, double* y, double* z, char id) {
  return put_part("dhdGetPosition", id, x, y, z, [](const Pose& pose) { return pose.p_UT; });
}
int dhdGetLinearVelocity(double* x, double* y, double* z, char id) {
  return put_part("dhdGetLinearVelocity", id, x, y, z, [](const Pose& pose) { return pose.v_UT; });
}
int dhdGetAngularVelocityRad(double* x, double* y, double* z, char id) {
  return put_part("dhdGetAngularVelocityRad", id, x, y, z,
                  [](const Pose& pose) { return pose.w_UT; });
}
int dhdGetAngularVelocityDeg(double* x, double* y, double* z, char id) {
  return put_part("dhdGetAngularVelocityDeg", id, x, y, z,
                  [](const Pose& pose) -> Eigen::Vector3d { return pose.w_UT / kDegree; });
}
int dhdGetOrientationRad(double* a, double* b, double* c, char id) {
  return put_part("dhdGetOrientationRad", id, a, b, c,
                  [](const Pose& pose) { return euler_angles(pose.R_UT); });
}
int dhdGetOrientationDeg(double* a, double* b, double* c, char id) {
  return put_part("dhdGetOrientationDeg", id, a, b, c, [](const Pose& pose) -> Eigen::Vector3d {
    return euler_angles(pose.R_UT) / kDegree;
  });
}

int dhdGetOrientationFrame(double rows[3][3], char id) {
  Pose pose;
  if (!open_arm("dhdGetOrientationFrame", id) || !none_null("dhdGetOrientationFrame", rows)) {
    return -1;
  }
  if (!pose_of("dhdGetOrientationFrame", id, pose)) return -1;
  put(pose.R_UT, rows);
  return 0;
}

int dhdGetPositionAndOrientationRad(double* x, double* y, double* z, double* a, double* b,
                                    double* c, char id) {
  return put_pose("dhdGetPositionAndOrientationRad", id, 1, x, y, z, a, b, c);
}
int dhdGetPositionAndOrientationDeg(double* x, double* y, double* z, double* a, double* b,
                                    double* c, char id) {
  return put_pose("dhdGetPositionAndOrientationDeg", id, kDegree, x, y, z, a, b, c);
}

int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double rows[3][3], char id) {
  constexpr const char* kFunction = "dhdGetPositionAndOrientationFrame";
  Pose pose;
  if (!open_arm(kFunction, id) || !none_null(kFunction, x, y, z, rows)) return -1;
  if (!pose_of(kFunction, id, pose)) return -1;
  put(pose.p_UT, x, y, z);
  put(pose.R_UT, rows);
  return 0;
}

int drdGetPositionAndOrientation(double* x, double* y, double* z, double* a, double* b, double* c,
                                 double* gripper, double rows[3][3], char id) {
  constexpr const char* kFunction = "drdGetPositionAndOrientation";
  OpenArm* arm = open_arm(kFunction, id);
  if (!arm || !none_null(kFunction, x, y, z, a, b, c, gripper, rows)) return -1;
  Pose pose;
  if (!pose_of(kFunction, id, pose)) return -1;
  put(pose.p_UT, x, y, z);
  put(euler_angles(pose.R_UT), a, b, c);
  put(pose.R_UT, rows);
  *gripper = 0;
  if (arms::facts(arm->number).has_gripper) dhdGetGripperAngleRad(gripper, id);
  return 0;
}

int drdGetVelocity(double* x, double* y, double* z, double* wx, double* wy, double* wz,
                   double* gripper, char id) {
  OpenArm* arm = open_arm("drdGetVelocity", id);
  if (!arm || !none_null("drdGetVelocity", x, y, z, wx, wy, wz, gripper)) return -1;
  Pose pose;
  if (!pose_of("drdGetVelocity", id, pose)) return -1;
  put(pose.v_UT, x, y, z);
  put(pose.w_UT, wx, wy, wz);
  *gripper = 0;
  if (arms::facts(arm->number).has_gripper) dhdGetGripperAngularVelocityRad(gripper, id);
  return 0;
}

}  // extern "C"
