/* A program that hangs: its own watchdog disables the force, and only the program can enable it. */
#include "check.h"

static int off_cause(void) {
  int status[DHD_MAX_STATUS];
  CHECK(dhdGetStatus(status, -1) == 0);
  return status[DHD_STATUS_FORCE_OFF_CAUSE];
}

static double push(int times) {
  double x, y, z;
  int i;
  for (i = 0; i < times; ++i) CHECK(dhdSetForce(0, 0.5, 0, -1) == 0);
  CHECK(dhdGetForce(&x, &y, &z, -1) == 0);
  return y;
}

int main(void) {
  double x, y, z;
  OPEN_ARM(0);
  CHECK(dhdEnableExpertMode() == 0);
  CHECK(dhdSetWatchdog(152, -1) == 0); /* 19 ms */
  CHECK_NEAR(push(600), 0.5, 1e-9);
  dhdSleep(0.06);
  CHECK(dhdGetForce(&x, &y, &z, -1) == 0);
  CHECK(y == 0);
  CHECK(push(100) == 0);
  CHECK(off_cause() == 3);
  CHECK(dhdEnableForce(DHD_ON, -1) == 0);
  CHECK_NEAR(push(600), 0.5, 1e-9);
  CHECK(off_cause() == 0);
  CHECK(dhdStop(-1) == 0);
  CHECK(push(50) == 0);
  CHECK(off_cause() == 4);
  CHECK(dhdClose(-1) == 0);
  printf("watchdog trip: PASSED\n");
  return 0;
}
