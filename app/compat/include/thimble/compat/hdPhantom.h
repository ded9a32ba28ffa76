#pragma once

/* What libhdPhantom.so exports: the functions by which CHAI3D and AMBF reach an arm, loaded at run
 * time. Own work; names and types as public programs under BSD licences use them
 * (app/compat/PROVENANCE.md).
 *
 * x to the user, y right, z up; m, m/s, N, N m; rotations row by row. Arms are numbered from 0.
 * What gets or closes returns 1, what opens or sets 0, and all of them -1 if it fails: such a
 * program takes what a getter returns for the truth of its success. */

#ifdef __cplusplus
extern "C" {
#endif

/** Returns how many arms there are. */
int hdPhantomGetNumDevices(void);
/** Opens an arm and switches its force on. */
int hdPhantomOpen(int id);
/** Closes an arm. */
int hdPhantomClose(int id);
/** Gets the tip's position. */
int hdPhantomGetPosition(int id, double* x, double* y, double* z);
/** Gets the tip's velocity. */
int hdPhantomGetLinearVelocity(int id, double* x, double* y, double* z);
/** Gets how the stylus is turned. */
int hdPhantomGetRotation(int id, double* r00, double* r01, double* r02, double* r10, double* r11,
                         double* r12, double* r20, double* r21, double* r22);
/** Returns the buttons, a bit each; 0 if the arm is not open. */
int hdPhantomGetButtons(int id);
/** Asks for a force, and waits until a tick has taken it: once for each is the pace of a loop. */
int hdPhantomSetForce(int id, const double* x, const double* y, const double* z);
/** The same with a torque, which arms of three motors do not give. */
int hdPhantomSetTorque(int id, const double* x, const double* y, const double* z);
/** The same with both. */
int hdPhantomSetForceAndTorque(int id, const double* fx, const double* fy, const double* fz,
                               const double* tx, const double* ty, const double* tz);
/** Gets the radius of the workspace; the arm need not be open. */
int hdPhantomGetWorkspaceRadius(int id, double* radius);
/** Copies the model's name, 255 bytes at most; the arm need not be open. */
int hdPhantomGetType(int id, char* name);
/** Does nothing: the servo runs while an arm is open. */
void hdPhantomStartServo(void);
/** Sets all forces to zero. */
void hdPhantomStopServo(void);

#ifdef __cplusplus
}
#endif
