/* Queries the features of the arm before it uses them. This arm measures its stylus, and has no
 * gripper. */
#include "check.h"

int main(void) {
  double gap = 7, force[3], torque[3], grip, rows[3][3], a, b, c, turned = 0;
  int i, k, n;
  OPEN_ARM(0);
  CHECK(dhdHasWrist(-1) && !dhdHasActiveWrist(-1));
  CHECK(!dhdHasGripper(-1) && !dhdHasActiveGripper(-1));
  CHECK(dhdGetGripperGap(&gap, -1) == -1 && gap == 7);
  CHECK(dhdErrorGetLast() == DHD_ERROR_NOT_AVAILABLE);
  CHECK(dhdEmulateButton(DHD_ON, -1) == -1);
  for (n = 0; n < 600; ++n) {
    CHECK(dhdSetForceAndTorqueAndGripperForce(0.2, 0, 0, 0.01, 0.02, 0.03, 1, -1) == 0);
    CHECK(dhdGetOrientationFrame(rows, -1) == 0);
    CHECK(dhdGetOrientationRad(&a, &b, &c, -1) == 0);
    for (i = 0; i < 3; ++i) {
      double length = 0;
      for (k = 0; k < 3; ++k) length += rows[i][k] * rows[i][k];
      CHECK_NEAR(length, 1, 1e-6);
    }
    if (fabs(a) + fabs(b) + fabs(c) > turned) turned = fabs(a) + fabs(b) + fabs(c);
  }
  CHECK(turned > 0.05);
  CHECK(dhdGetForceAndTorqueAndGripperForce(&force[0], &force[1], &force[2], &torque[0], &torque[1],
                                            &torque[2], &grip, -1) == 0);
  CHECK_NEAR(force[0], 0.2, 1e-9);
  CHECK(torque[2] == 0 && grip == 0);
  CHECK(dhdClose(-1) == 0);
  printf("gripper: PASSED\n");
  return 0;
}
