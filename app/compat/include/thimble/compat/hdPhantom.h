#pragma once

/* Functions that libhdPhantom.so exports. CHAI3D and AMBF load it at run time to access an arm.
 * Written for Thimble; names and types are those of public programs under BSD licences
 * (app/compat/PROVENANCE.md).
 *
 * x to the user, y right, z up; m, m/s, N, N m; rotations row by row. Arms are numbered from 0.
 * Functions that get or close return 1, functions that open or set return 0, and all return -1 on
 * failure, because these programs use the result of a getter as a flag of success. */

#ifdef __cplusplus
extern "C" {
#endif

/** Returns the number of arms. */
int hdPhantomGetNumDevices(void);
/** Opens an arm and switches its force on. */
int hdPhantomOpen(int id);
/** Closes an arm. */
int hdPhantomClose(int id);
/** Gets the tip's position. */
int hdPhantomGetPosition(int id, double* x, double* y, double* z);
/** Gets the tip's velocity. */
int hdPhantomGetLinearVelocity(int id, double* x, double* y, double* z);
/** Gets the rotation of the stylus. */
int hdPhantomGetRotation(int id, double* r00, double* r01, double* r02, double* r10, double* r11,
                         double* r12, double* r20, double* r21, double* r22);
/** Returns the buttons, one bit each; 0 if the arm is not open. */
int hdPhantomGetButtons(int id);
/** Requests a force and waits until a tick has taken it; one call per tick paces a loop. */
int hdPhantomSetForce(int id, const double* x, const double* y, const double* z);
/** Does the same with a torque, which arms with three motors cannot produce. */
int hdPhantomSetTorque(int id, const double* x, const double* y, const double* z);
/** Does the same with force and torque. */
int hdPhantomSetForceAndTorque(int id, const double* fx, const double* fy, const double* fz,
                               const double* tx, const double* ty, const double* tz);
/** Gets the radius of the workspace; the arm need not be open. */
int hdPhantomGetWorkspaceRadius(int id, double* radius);
/** Copies the name of the model, at most 255 bytes; the arm need not be open. */
int hdPhantomGetType(int id, char* name);
/** Does nothing: the servo runs while an arm is open. */
void hdPhantomStartServo(void);
/** Sets all forces to zero. */
void hdPhantomStopServo(void);

#ifdef __cplusplus
}
#endif
