/* Opens the first arm and requests a constant force. The set-force call paces the loop. */
#include <dlfcn.h>
#include <string.h>

#include "check.h"

int main(void) {
  double x, y, z, begin, took;
  int i, version[4], status[DHD_MAX_STATUS];
  unsigned short serial = 0;
  dhdGetSDKVersion(&version[0], &version[1], &version[2], &version[3]);
  CHECK(version[0] == 3 && version[1] >= 16);
  CHECK(dhdGetDeviceCount() == 1);
  CHECK(dhdOpen() == 0);
  CHECK(strcmp(dhdGetSystemName(-1), "vintage_phantom") == 0);
  CHECK(dhdGetSystemType(-1) == DHD_DEVICE_CUSTOM);
  CHECK(dhdGetSerialNumber(&serial, -1) == 0 && serial == 1);
  CHECK(!dhdIsLeftHanded(-1));
  CHECK(dhdEnableForce(DHD_ON, -1) == 0);
  for (i = 0; i < 500; ++i) CHECK(dhdSetForce(0.4, -0.3, 0.2, -1) == 0);
  begin = dhdGetTime();
  for (i = 0; i < 1000; ++i) CHECK(dhdSetForce(0.4, -0.3, 0.2, -1) == 0);
  took = dhdGetTime() - begin;
  printf("1000 forces took %.3f s\n", took);
  CHECK(took > 0.95);
  CHECK(dhdGetForce(&x, &y, &z, -1) == 0);
  CHECK_NEAR(x, 0.4, 1e-9);
  CHECK_NEAR(y, -0.3, 1e-9);
  CHECK_NEAR(z, 0.2, 1e-9);
  /* The hand, of 300 N/m, yields. */
  CHECK(dhdGetPosition(&x, &y, &z, -1) == 0);
  CHECK_NEAR(x, 0.4 / 300, 0.0006);
  CHECK_NEAR(y, -0.3 / 300, 0.0006);
  CHECK(dhdGetStatus(status, -1) == 0);
  CHECK(status[DHD_STATUS_FORCE] == 1 && status[DHD_STATUS_ERROR] == 0);
  /* Both names belong to one library. */
  CHECK(dlsym(dlopen("libdhd.so.3", RTLD_NOW), "dhdOpen") == dlsym(RTLD_DEFAULT, "dhdOpen"));
  CHECK(dlsym(dlopen("libdrd.so.3", RTLD_NOW), "drdOpen") ==
        dlsym(dlopen("libdhd.so", RTLD_NOW), "drdOpen"));
  CHECK(dhdStop(-1) == 0);
  CHECK(dhdClose(-1) == 0);
  printf("hello force: PASSED\n");
  return 0;
}
