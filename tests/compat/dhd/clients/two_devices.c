/* Two arms in one loop, with different forces. */
#include "check.h"

int main(void) {
  double f[3];
  int i;
  char id;
  CHECK(dhdGetDeviceCount() == 2);
  for (id = 0; id < 2; ++id) OPEN_ARM(id);
  CHECK(dhdGetDeviceID() == 1);
  for (i = 0; i < 600; ++i) {
    CHECK(dhdSetForce(0.3, 0, 0, 0) == 0);
    CHECK(dhdSetForce(0, 0.2, -0.1, 1) == 0);
  }
  CHECK(dhdGetForce(&f[0], &f[1], &f[2], 0) == 0);
  CHECK_NEAR(f[0], 0.3, 1e-9);
  CHECK_NEAR(f[1], 0, 1e-9);
  CHECK(dhdGetForce(&f[0], &f[1], &f[2], 1) == 0);
  CHECK_NEAR(f[1], 0.2, 1e-9);
  CHECK_NEAR(f[2], -0.1, 1e-9);
  CHECK(dhdClose(0) == 0);
  for (i = 0; i < 50; ++i) CHECK(dhdSetForce(0, 0.2, -0.1, 1) == 0);
  CHECK(dhdSetForce(0.3, 0, 0, 0) == -1 && dhdErrorGetLast() == DHD_ERROR_DEVICE_NOT_READY);
  CHECK(dhdClose(1) == 0);
  printf("two devices: PASSED\n");
  return 0;
}
