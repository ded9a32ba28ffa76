#ifndef THIMBLE_COMPAT_DRDC_H
#define THIMBLE_COMPAT_DRDC_H

/* Declarations for building a C or C++ program that moves and holds an arm with the drd... API; see
 * dhdc.h. Thimble holds and moves an arm by a spring between its tip and a moving target, with the
 * force that the gate allows. */

#include "dhdc.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Listing and opening of arms, as dhdOpen and others. */
int drdOpen(void);
int drdOpenID(char index);
int drdClose(THIMBLE_DHD_ID);
int drdSetDevice(char id);
int drdGetDeviceID(void);
bool drdIsSupported(THIMBLE_DHD_ID);
bool drdIsInitialized(THIMBLE_DHD_ID);
int drdAutoInit(THIMBLE_DHD_ID);
int drdCheckInit(THIMBLE_DHD_ID);
int drdPrecisionInit(THIMBLE_DHD_ID);

/* The control thread. */
int drdStart(THIMBLE_DHD_ID);
int drdStop(THIMBLE_DHD_DEFAULT(bool leave_force_on, false), THIMBLE_DHD_ID);
bool drdIsRunning(THIMBLE_DHD_ID);
bool drdIsMoving(THIMBLE_DHD_ID);
bool drdIsFiltering(THIMBLE_DHD_ID);
int drdWaitForTick(THIMBLE_DHD_ID);
double drdGetCtrlFreq(THIMBLE_DHD_ID); /* kHz */
int drdRegulatePos(bool on, THIMBLE_DHD_ID);
int drdRegulateRot(bool on, THIMBLE_DHD_ID);
int drdRegulateGrip(bool on, THIMBLE_DHD_ID);
int drdEnableFilter(bool on, THIMBLE_DHD_ID);
int drdSetMotRatioMax(double ratio, THIMBLE_DHD_ID);
double drdGetMotRatioMax(THIMBLE_DHD_ID);

/* Motion of the arm. */
int drdMoveToPos(double x, double y, double z, THIMBLE_DHD_DEFAULT(bool wait, true),
                 THIMBLE_DHD_ID);
int drdMoveTo(double goal[DHD_MAX_DOF], THIMBLE_DHD_DEFAULT(bool wait, true), THIMBLE_DHD_ID);
int drdTrackPos(double x, double y, double z, THIMBLE_DHD_ID);
int drdTrack(double goal[DHD_MAX_DOF], THIMBLE_DHD_ID);
int drdHold(THIMBLE_DHD_ID);
int drdSetPosMoveParam(double acceleration, double speed, double jerk, THIMBLE_DHD_ID);
int drdGetPosMoveParam(double* acceleration, double* speed, double* jerk, THIMBLE_DHD_ID);
int drdSetPosTrackParam(double acceleration, double speed, double jerk, THIMBLE_DHD_ID);
int drdGetPosTrackParam(double* acceleration, double* speed, double* jerk, THIMBLE_DHD_ID);

/* Gains of the regulation, as multiples of the default: stiffness (P), damping (D); I is only
 * stored.
 */
int drdSetEncPGain(double gain, THIMBLE_DHD_ID);
double drdGetEncPGain(THIMBLE_DHD_ID);
int drdSetEncIGain(double gain, THIMBLE_DHD_ID);
double drdGetEncIGain(THIMBLE_DHD_ID);
int drdSetEncDGain(double gain, THIMBLE_DHD_ID);
double drdGetEncDGain(THIMBLE_DHD_ID);

/* Wrist, gripper and single encoders: bounds are stored, motions are refused, because the arms have
 * no motors for them. */
int drdMoveToRot(double a, double b, double c, THIMBLE_DHD_DEFAULT(bool wait, true),
                 THIMBLE_DHD_ID);
int drdTrackRot(double a, double b, double c, THIMBLE_DHD_ID);
int drdMoveToGrip(double gripper, THIMBLE_DHD_DEFAULT(bool wait, true), THIMBLE_DHD_ID);
int drdTrackGrip(double gripper, THIMBLE_DHD_ID);
int drdSetRotMoveParam(double acceleration, double speed, double jerk, THIMBLE_DHD_ID);
int drdGetRotMoveParam(double* acceleration, double* speed, double* jerk, THIMBLE_DHD_ID);
int drdSetRotTrackParam(double acceleration, double speed, double jerk, THIMBLE_DHD_ID);
int drdGetRotTrackParam(double* acceleration, double* speed, double* jerk, THIMBLE_DHD_ID);
int drdSetGripMoveParam(double acceleration, double speed, double jerk, THIMBLE_DHD_ID);
int drdGetGripMoveParam(double* acceleration, double* speed, double* jerk, THIMBLE_DHD_ID);
int drdSetGripTrackParam(double acceleration, double speed, double jerk, THIMBLE_DHD_ID);
int drdGetGripTrackParam(double* acceleration, double* speed, double* jerk, THIMBLE_DHD_ID);
int drdSetEncMoveParam(double acceleration, double speed, double jerk, THIMBLE_DHD_ID);
int drdGetEncMoveParam(double* acceleration, double* speed, double* jerk, THIMBLE_DHD_ID);
int drdSetEncTrackParam(double acceleration, double speed, double jerk, THIMBLE_DHD_ID);
int drdGetEncTrackParam(double* acceleration, double* speed, double* jerk, THIMBLE_DHD_ID);

/* State and force of the arm, and time. */
int drdGetPositionAndOrientation(double* x, double* y, double* z, double* a, double* b, double* c,
                                 double* gripper, double rows[3][3], THIMBLE_DHD_ID);
int drdGetVelocity(double* x, double* y, double* z, double* wx, double* wy, double* wz,
                   double* gripper, THIMBLE_DHD_ID);
int drdSetForceAndTorqueAndGripperForce(double force[DHD_MAX_DOF], THIMBLE_DHD_ID);
int drdSetForceAndWristJointTorquesAndGripperForce(double force[DHD_MAX_DOF], THIMBLE_DHD_ID);

double drdGetTime(void);
void drdSleep(double seconds);

#ifdef __cplusplus
}
#endif

#endif
