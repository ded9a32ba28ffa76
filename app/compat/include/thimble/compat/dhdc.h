#ifndef THIMBLE_COMPAT_DHDC_H
#define THIMBLE_COMPAT_DHDC_H

/* Declarations for building a C or C++ program that uses the dhd... API: the functions that
 * `libdhd.so` and `libdrd.so` of `thimble exec` implement. The text is Thimble's; names, types and
 * numbers are those that programs use (app/compat/dhd/PROVENANCE.md). app/compat/dhd/README.md
 * describes the behaviour of each function.
 *
 * Units: m, N, N m, rad, kg, s; degrees in names that end with Deg. x to the user, y to the user's
 * right, z up. `id`: number of the arm; -1: the one that was opened or selected last (optional in
 * C++). Functions return 0 or more, or -1 on an error, which dhdErrorGetLast then returns to the
 * calling thread. */

#include <stdbool.h>

#define DHD_ON 1
#define DHD_OFF 0
#define DHD_UNDEFINED (-1)

#define DHD_MAX_DEVICE 4
#define DHD_MAX_DOF 8
#define DHD_MAX_BUTTONS 16
#define DHD_MAX_STATUS 17

/* Return values, in addition to 0, of functions that send a force. */
#define DHD_TIMEGUARD 1
#define DHD_MOTOR_SATURATED 2

/* Return values of dhdGetSystemType. */
#define DHD_DEVICE_NONE 0
#define DHD_DEVICE_3DOF 31
#define DHD_DEVICE_OMEGA 32
#define DHD_DEVICE_OMEGA3 33
#define DHD_DEVICE_OMEGA33 34
#define DHD_DEVICE_OMEGA331 35
#define DHD_DEVICE_OMEGA33_LEFT 36
#define DHD_DEVICE_OMEGA331_LEFT 37
#define DHD_DEVICE_FALCON 60
#define DHD_DEVICE_DELTA3 63
#define DHD_DEVICE_DELTA6 64
#define DHD_DEVICE_CONTROLLER 81
#define DHD_DEVICE_CONTROLLER_HR 82
#define DHD_DEVICE_CUSTOM 91
#define DHD_DEVICE_DLR331 102
#define DHD_DEVICE_DLR331_LEFT 103
#define DHD_DEVICE_SIGMA331 104
#define DHD_DEVICE_SIGMA331_LEFT 105
#define DHD_DEVICE_SIGMA33P 106
#define DHD_DEVICE_SIGMA33P_LEFT 107
#define DHD_DEVICE_LAMBDA331 108
#define DHD_DEVICE_LAMBDA331_LEFT 109
#define DHD_DEVICE_LAMBDA33 131
#define DHD_DEVICE_LAMBDA33_LEFT 132
#define DHD_DEVICE_LAMBDA3 203
#define DHD_DEVICE_SIGMA3 206

/* Indices into the array that dhdGetStatus sets. */
#define DHD_STATUS_POWER 0
#define DHD_STATUS_CONNECTED 1
#define DHD_STATUS_STARTED 2
#define DHD_STATUS_RESET 3
#define DHD_STATUS_IDLE 4
#define DHD_STATUS_FORCE 5
#define DHD_STATUS_BRAKE 6
#define DHD_STATUS_TORQUE 7
#define DHD_STATUS_WRIST_DETECTED 8
#define DHD_STATUS_ERROR 9
#define DHD_STATUS_GRAVITY 10
#define DHD_STATUS_TIMEGUARD 11
#define DHD_STATUS_WRIST_INIT 12
#define DHD_STATUS_REDUNDANCY 13
#define DHD_STATUS_FORCE_OFF_CAUSE 14

/* Causes of a force that is off (DHD_STATUS_FORCE_OFF_CAUSE). */
#define DHD_FORCEOFF_NONE 0
#define DHD_FORCEOFF_BUTTON 1
#define DHD_FORCEOFF_VELOCITY 2
#define DHD_FORCEOFF_WATCHDOG 3
#define DHD_FORCEOFF_SOFTWARE 4
#define DHD_FORCEOFF_USBDISCN 5
#define DHD_FORCEOFF_DEADMAN 6

/* Priorities of dhdStartThread. */
#define DHD_THREAD_PRIORITY_DEFAULT 0
#define DHD_THREAD_PRIORITY_HIGH 1
#define DHD_THREAD_PRIORITY_LOW 2

/* Return values of dhdErrorGetLast. */
enum {
  DHD_NO_ERROR = 0,
  DHD_ERROR = 1,
  DHD_ERROR_COM = 2,
  DHD_ERROR_DHC_BUSY = 3,
  DHD_ERROR_NO_DRIVER_FOUND = 4,
  DHD_ERROR_NO_DEVICE_FOUND = 5,
  DHD_ERROR_NOT_AVAILABLE = 6,
  DHD_ERROR_TIMEOUT = 7,
  DHD_ERROR_GEOMETRY = 8,
  DHD_ERROR_EXPERT_MODE_DISABLED = 9,
  DHD_ERROR_NOT_IMPLEMENTED = 10,
  DHD_ERROR_OUT_OF_MEMORY = 11,
  DHD_ERROR_DEVICE_NOT_READY = 12,
  DHD_ERROR_FILE_NOT_FOUND = 13,
  DHD_ERROR_CONFIGURATION = 14,
  DHD_ERROR_INVALID_INDEX = 15,
  DHD_ERROR_DEPRECATED = 16,
  DHD_ERROR_NULL_ARGUMENT = 17,
  DHD_ERROR_REDUNDANT_FAIL = 18,
  DHD_ERROR_NOT_ENABLED = 19,
  DHD_ERROR_DEVICE_IN_USE = 20,
  DHD_ERROR_INVALID = 21,
  DHD_ERROR_NO_REGULATION = 22
};

typedef unsigned char uchar;
typedef unsigned short ushort; /* as glibc has these two */
typedef unsigned int uint;

#ifdef __cplusplus
#define THIMBLE_DHD_ID char id = -1
#define THIMBLE_DHD_MASK unsigned char mask = 0xff
#define THIMBLE_DHD_DEFAULT(parameter, value) parameter = value
extern "C" {
#else
#define THIMBLE_DHD_ID char id
#define THIMBLE_DHD_MASK unsigned char mask
#define THIMBLE_DHD_DEFAULT(parameter, value) parameter
#endif

/* Errors. */
int dhdErrorGetLast(void);
const char* dhdErrorGetLastStr(void);
const char* dhdErrorGetStr(int error);

/* Listing and opening of arms. */
void dhdEnableSimulator(bool on);
int dhdGetDeviceCount(void);
int dhdGetAvailableCount(void);
int dhdSetDevice(char id);
int dhdGetDeviceID(void);
int dhdGetSerialNumber(unsigned short* serial, THIMBLE_DHD_ID);
int dhdOpen(void);
int dhdOpenType(int type);
int dhdOpenSerial(int serial);
int dhdOpenID(char index);
int dhdClose(THIMBLE_DHD_ID);
int dhdGetSystemType(THIMBLE_DHD_ID);
const char* dhdGetSystemName(THIMBLE_DHD_ID);
void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision);
const char* dhdGetSDKVersionStr(void);
int dhdGetStatus(int status[DHD_MAX_STATUS], THIMBLE_DHD_ID);
bool dhdIsLeftHanded(THIMBLE_DHD_ID);
bool dhdHasBase(THIMBLE_DHD_ID);
bool dhdHasWrist(THIMBLE_DHD_ID);
bool dhdHasActiveWrist(THIMBLE_DHD_ID);
bool dhdHasGripper(THIMBLE_DHD_ID);
bool dhdHasActiveGripper(THIMBLE_DHD_ID);

/* Force on and off, and settings of an arm. */
int dhdStop(THIMBLE_DHD_ID);
int dhdEnableForce(unsigned char on, THIMBLE_DHD_ID);
int dhdReset(THIMBLE_DHD_ID);
int dhdWaitForReset(THIMBLE_DHD_DEFAULT(int timeout_ms, 0), THIMBLE_DHD_ID);
int dhdSetGravityCompensation(THIMBLE_DHD_DEFAULT(int on, DHD_ON), THIMBLE_DHD_ID);
int dhdSetBrakes(THIMBLE_DHD_DEFAULT(int on, DHD_ON), THIMBLE_DHD_ID);
int dhdGetEffectorMass(double* mass, THIMBLE_DHD_ID);
int dhdSetEffectorMass(double mass, THIMBLE_DHD_ID);
int dhdGetDeviceAngleRad(double* angle, THIMBLE_DHD_ID);
int dhdGetDeviceAngleDeg(double* angle, THIMBLE_DHD_ID);
int dhdSetDeviceAngleRad(double angle, THIMBLE_DHD_ID);
int dhdSetDeviceAngleDeg(double angle, THIMBLE_DHD_ID);
int dhdGetBaseAngleXRad(double* angle, THIMBLE_DHD_ID);
int dhdGetBaseAngleXDeg(double* angle, THIMBLE_DHD_ID);
int dhdSetBaseAngleXRad(double angle, THIMBLE_DHD_ID);
int dhdSetBaseAngleXDeg(double angle, THIMBLE_DHD_ID);
int dhdGetBaseAngleZRad(double* angle, THIMBLE_DHD_ID);
int dhdGetBaseAngleZDeg(double* angle, THIMBLE_DHD_ID);
int dhdSetBaseAngleZRad(double angle, THIMBLE_DHD_ID);
int dhdSetBaseAngleZDeg(double angle, THIMBLE_DHD_ID);
double dhdGetMaxForce(THIMBLE_DHD_ID);
int dhdSetMaxForce(double newtons, THIMBLE_DHD_ID);

/* Pose and velocity of the tip. */
int dhdGetPosition(double* x, double* y, double* z, THIMBLE_DHD_ID);
int dhdGetLinearVelocity(double* x, double* y, double* z, THIMBLE_DHD_ID);
int dhdGetOrientationRad(double* a, double* b, double* c, THIMBLE_DHD_ID);
int dhdGetOrientationDeg(double* a, double* b, double* c, THIMBLE_DHD_ID);
int dhdGetOrientationFrame(double rows[3][3], THIMBLE_DHD_ID);
int dhdGetPositionAndOrientationRad(double* x, double* y, double* z, double* a, double* b,
                                    double* c, THIMBLE_DHD_ID);
int dhdGetPositionAndOrientationDeg(double* x, double* y, double* z, double* a, double* b,
                                    double* c, THIMBLE_DHD_ID);
int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double rows[3][3],
                                      THIMBLE_DHD_ID);
int dhdGetAngularVelocityRad(double* x, double* y, double* z, THIMBLE_DHD_ID);
int dhdGetAngularVelocityDeg(double* x, double* y, double* z, THIMBLE_DHD_ID);

/* Gripper and buttons. */
int dhdGetGripperAngleRad(double* angle, THIMBLE_DHD_ID);
int dhdGetGripperAngleDeg(double* angle, THIMBLE_DHD_ID);
int dhdGetGripperGap(double* gap, THIMBLE_DHD_ID);
int dhdGetGripperThumbPos(double* x, double* y, double* z, THIMBLE_DHD_ID);
int dhdGetGripperFingerPos(double* x, double* y, double* z, THIMBLE_DHD_ID);
int dhdGetGripperLinearVelocity(double* velocity, THIMBLE_DHD_ID);
int dhdGetGripperAngularVelocityRad(double* velocity, THIMBLE_DHD_ID);
int dhdGetGripperAngularVelocityDeg(double* velocity, THIMBLE_DHD_ID);
int dhdGetButton(int index, THIMBLE_DHD_ID);
unsigned int dhdGetButtonMask(THIMBLE_DHD_ID);
int dhdEmulateButton(unsigned char on, THIMBLE_DHD_ID);

/* Forces. Each of the first five functions waits until a tick has taken the force. */
int dhdSetForce(double x, double y, double z, THIMBLE_DHD_ID);
int dhdSetForceAndTorque(double fx, double fy, double fz, double tx, double ty, double tz,
                         THIMBLE_DHD_ID);
int dhdSetForceAndGripperForce(double fx, double fy, double fz, double gripper, THIMBLE_DHD_ID);
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty,
                                        double tz, double gripper, THIMBLE_DHD_ID);
int dhdSetForceAndWristJointTorques(double fx, double fy, double fz, double t0, double t1,
                                    double t2, THIMBLE_DHD_ID);
int dhdSetForceAndWristJointTorquesAndGripperForce(double fx, double fy, double fz, double t0,
                                                   double t1, double t2, double gripper,
                                                   THIMBLE_DHD_ID);
int dhdSetJointTorques(double torques[DHD_MAX_DOF], THIMBLE_DHD_MASK, THIMBLE_DHD_ID);
int dhdSetVibration(double frequency, double amplitude, THIMBLE_DHD_DEFAULT(int type, 0),
                    THIMBLE_DHD_ID);
int dhdGetForce(double* x, double* y, double* z, THIMBLE_DHD_ID);
int dhdGetForceAndTorque(double* fx, double* fy, double* fz, double* tx, double* ty, double* tz,
                         THIMBLE_DHD_ID);
int dhdGetForceAndTorqueAndGripperForce(double* fx, double* fy, double* fz, double* tx, double* ty,
                                        double* tz, double* gripper, THIMBLE_DHD_ID);
double dhdGetComFreq(THIMBLE_DHD_ID); /* kHz */

/* For experts. Functions that could disturb an arm require a call of dhdEnableExpertMode first. */
int dhdEnableExpertMode(void);
int dhdDisableExpertMode(void);
int dhdPreset(int counts[DHD_MAX_DOF], unsigned char mask, THIMBLE_DHD_ID);
int dhdSetMot(unsigned short values[DHD_MAX_DOF], THIMBLE_DHD_MASK, THIMBLE_DHD_ID);
int dhdSetWatchdog(unsigned char steps, THIMBLE_DHD_ID); /* steps of 125 us; 0: the arm's default */
int dhdGetWatchdog(unsigned char* steps, THIMBLE_DHD_ID);
int dhdSetVelocityThreshold(unsigned int speed, THIMBLE_DHD_ID); /* m/s; 0: the arm's default */
int dhdGetVelocityThreshold(unsigned int* speed, THIMBLE_DHD_ID);
int dhdGetEnc(int counts[DHD_MAX_DOF], THIMBLE_DHD_MASK, THIMBLE_DHD_ID);
int dhdGetEncVelocities(double counts_per_s[DHD_MAX_DOF], THIMBLE_DHD_ID);
int dhdGetJointAngles(double angles[DHD_MAX_DOF], THIMBLE_DHD_ID);
int dhdGetJointVelocities(double velocities[DHD_MAX_DOF], THIMBLE_DHD_ID);
int dhdGetJointAngleRange(double least[DHD_MAX_DOF], double most[DHD_MAX_DOF], THIMBLE_DHD_ID);
int dhdGetDeltaEncoders(int* first, int* second, int* third, THIMBLE_DHD_ID);
int dhdGetDeltaJointAngles(double* first, double* second, double* third, THIMBLE_DHD_ID);
int dhdGetWristJointAngles(double* first, double* second, double* third, THIMBLE_DHD_ID);
int dhdDeltaJointAnglesToJacobian(double first, double second, double third, double rows[3][3],
                                  THIMBLE_DHD_ID);
int dhdWristJointAnglesToJacobian(double first, double second, double third, double rows[3][3],
                                  THIMBLE_DHD_ID);
int dhdGetDeltaJacobian(double rows[3][3], THIMBLE_DHD_ID);
int dhdGetWristJacobian(double rows[3][3], THIMBLE_DHD_ID);
int dhdJointAnglesToInertiaMatrix(double angles[DHD_MAX_DOF], double rows[6][6], THIMBLE_DHD_ID);
int dhdJointAnglesToGravityJointTorques(double angles[DHD_MAX_DOF], double torques[DHD_MAX_DOF],
                                        THIMBLE_DHD_MASK, THIMBLE_DHD_ID);

/* Time, keys, threads. */
double dhdGetTime(void);
void dhdSleep(double seconds);
bool dhdKbHit(void);
char dhdKbGet(void);
int dhdStartThread(void* function(void*), void* argument, int priority);

/* Functions that are exported and not answered. */
#ifdef __cplusplus
#define THIMBLE_DHD_UNANSWERED(result, name) result name(...);
#else
#define THIMBLE_DHD_UNANSWERED(result, name) result name();
#endif
#include "dhd_unanswered.inc"
#undef THIMBLE_DHD_UNANSWERED

#ifdef __cplusplus
}
#endif

#endif
