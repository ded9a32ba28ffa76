/* A spring to the centre of the workspace, with a button that ends the program: a typical first
 * program. */
#include "check.h"

int main(void) {
  const double stiffness = 20, damping = 2;
  double p[3], v[3], f[3], farthest = 0, worst = 0, last[3] = {0, 0, 0};
  int i;
  CHECK(dhdOpen() >= 0);
  CHECK(dhdSetGravityCompensation(DHD_ON, -1) == 0);
  CHECK(dhdSetBrakes(DHD_OFF, -1) == 0);
  for (i = 0; i < 2500 && dhdGetButton(0, -1) == 0; ++i) {
    CHECK(dhdGetPosition(&p[0], &p[1], &p[2], -1) >= 0);
    CHECK(dhdGetLinearVelocity(&v[0], &v[1], &v[2], -1) >= 0);
    CHECK(dhdGetForce(&f[0], &f[1], &f[2], -1) == 0);
    /* After the soft start, the motors must get the force requested in the last turn. */
    if (i > 600) {
      const double off = fabs(f[0] - last[0]) + fabs(f[1] - last[1]) + fabs(f[2] - last[2]);
      if (off > worst) worst = off;
    }
    last[0] = -stiffness * p[0] - damping * v[0];
    last[1] = -stiffness * p[1] - damping * v[1];
    last[2] = -stiffness * p[2] - damping * v[2];
    CHECK(dhdSetForceAndTorque(last[0], last[1], last[2], 0, 0, 0, -1) >= 0);
    if (fabs(p[1]) > farthest) farthest = fabs(p[1]);
  }
  printf("the hand went %.1f mm; worst difference of the force %.4f N\n", 1000 * farthest, worst);
  CHECK(i == 2500);
  CHECK(farthest > 0.02);
  CHECK(worst < 0.05);
  CHECK(dhdClose(-1) == 0);
  printf("spring to centre: PASSED\n");
  return 0;
}
