/* A program that was built against the maker's own headers: it has only the types of its own build.
 * Returns 0 if calls and results fit. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "../../clients/count_failures.h"

extern int dhdGetDeviceCount(void);
extern int dhdOpenID(char index);
extern int dhdClose(char id);
extern int dhdEnableForce(unsigned char on, char id);
extern int dhdGetSerialNumber(unsigned short* serial, char id);
extern const char* dhdGetSystemName(char id);
extern bool dhdHasWrist(char id);
extern bool dhdHasBase(char id);
extern unsigned int dhdGetButtonMask(char id);
extern int dhdGetPosition(double* x, double* y, double* z, char id);
extern int dhdGetOrientationFrame(double rows[3][3], char id);
extern int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx,
                                               double ty, double tz, double gripper, char id);
extern int dhdGetForce(double* x, double* y, double* z, char id);
extern int dhdGetEnc(int counts[8], unsigned char mask, char id);
extern int dhdSetVelocityThreshold(unsigned int speed, char id);
extern int dhdEnableExpertMode(void);
extern double dhdGetTime(void);
extern double drdGetMotRatioMax(char id);
extern int drdSetMotRatioMax(double ratio, char id);
extern bool drdIsRunning(char id);
extern int drdMoveToPos(double x, double y, double z, bool wait, char id);
extern int dhdErrorGetLast(void);

int main(void) {
  unsigned short serial = 0;
  double p[3], f[3], rows[3][3], begin;
  int counts[9] = {7, 7, 7, 7, 7, 7, 7, 7, 7}, i;
  CHECK(dhdGetDeviceCount() == 1);
  CHECK(dhdOpenID(0) == 0);
  CHECK(dhdGetSerialNumber(&serial, -1) == 0 && serial == 1);
  CHECK(dhdGetSystemName(-1)[0] == 'v');
  CHECK(dhdHasBase(-1) && !dhdHasWrist(-1) && dhdGetButtonMask(-1) == 0);
  CHECK(dhdEnableForce(1, -1) == 0);
  begin = dhdGetTime();
  for (i = 0; i < 500; ++i) {
    CHECK(dhdSetForceAndTorqueAndGripperForce(0.1, -0.2, 0.3, 0.01, 0.02, 0.03, 0.5, -1) == 0);
  }
  CHECK(dhdGetTime() - begin > 0.45);
  CHECK(dhdGetForce(&f[0], &f[1], &f[2], -1) == 0);
  CHECK(fabs(f[0] - 0.1) < 1e-9 && fabs(f[1] + 0.2) < 1e-9 && fabs(f[2] - 0.3) < 1e-9);
  CHECK(dhdGetPosition(&p[0], &p[1], &p[2], -1) >= 0 && fabs(p[2]) < 0.01);
  CHECK(dhdGetOrientationFrame(rows, -1) == 0 && rows[0][0] == 1 && rows[0][1] == 0);
  CHECK(dhdGetEnc(counts, 0x0f, -1) == 0 && counts[3] == 0 && counts[4] == 7 && counts[8] == 7);
  CHECK(dhdEnableExpertMode() == 0 && dhdSetVelocityThreshold(2, -1) == 0);
  CHECK(drdSetMotRatioMax(0.5, -1) == 0 && drdGetMotRatioMax(-1) == 0.5);
  CHECK(!drdIsRunning(-1));
  CHECK(drdMoveToPos(0, 0, 0, true, -1) == -1 && dhdErrorGetLast() == 22);
  CHECK(dhdClose(-1) == 0);
  printf("ABI of DHD: %d failures\n", failures);
  return failures != 0;
}
