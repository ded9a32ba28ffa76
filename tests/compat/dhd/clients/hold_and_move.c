/* Regulation: the arm holds a point, moves to another, follows a third, and is released. */
#include "check.h"

static double distance(double x, double y, double z) {
  double p[3];
  CHECK(dhdGetPosition(&p[0], &p[1], &p[2], -1) >= 0);
  return sqrt((p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y) + (p[2] - z) * (p[2] - z));
}

int main(void) {
  double f[3];
  int i;
  CHECK(drdOpenID(0) == 0);
  CHECK(drdAutoInit(-1) == 0);
  CHECK(drdIsRunning(-1));
  CHECK(drdStop(true, -1) == 0);
  CHECK(drdMoveToPos(0, 0, 0, true, -1) == -1 && dhdErrorGetLast() == DHD_ERROR_NO_REGULATION);
  CHECK(drdStart(-1) == 0);
  CHECK(drdIsRunning(-1));
  dhdSleep(0.6);
  CHECK(distance(0, 0, 0) < 0.002);
  /* The hand yields to the regulation. */
  CHECK(drdMoveToPos(0.006, 0, 0, false, -1) == 0);
  CHECK(drdIsMoving(-1));
  dhdSleep(1.5);
  printf("it is %.2f mm from its goal\n", 1000 * distance(0.006, 0, 0));
  CHECK(distance(0.006, 0, 0) < 0.002);
  CHECK(drdMoveToPos(0.02, -0.01, 0.01, true, -1) == 0);
  CHECK(distance(0.02, -0.01, 0.01) < 0.002);
  CHECK(!drdIsMoving(-1));
  CHECK(drdTrackPos(0, 0, 0, -1) == 0);
  dhdSleep(1.5);
  CHECK(distance(0, 0, 0) < 0.001);
  CHECK(!drdIsMoving(-1));
  CHECK(dhdSetForce(1, 0, 0, -1) == -1 && dhdErrorGetLast() == DHD_ERROR_DEVICE_IN_USE);
  CHECK(drdStop(true, -1) == 0);
  CHECK(!drdIsRunning(-1));
  for (i = 0; i < 400; ++i) CHECK(dhdSetForce(0, 0, 0.2, -1) == 0);
  CHECK(dhdGetForce(&f[0], &f[1], &f[2], -1) == 0);
  CHECK_NEAR(f[2], 0.2, 1e-9);
  CHECK(drdClose(-1) == 0);
  printf("hold and move: PASSED\n");
  return 0;
}
