/* A program that searches for arms through two libraries, opens the arm with the first and fails to
 * open it with the second. Returns 0 if each arm is listed once and the arm of the first library
 * still gets its forces. With the argument `second`, another program is started meanwhile, which is
 * refused and exits. */
#include <dlfcn.h>
#include <drdc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double kForce = 0.3; /* N */

static double sent_after(int ticks) {
  double x = 0, y = 0, z = 0;
  int i;
  for (i = 0; i < ticks; ++i) {
    if (dhdSetForce(kForce, 0, 0, 0) != 0) return -1;
  }
  return dhdGetForce(&x, &y, &z, 0) == 0 ? x : -1;
}

int main(int argc, char** argv) {
  void* phantom = dlopen("libhdPhantom.so", RTLD_LAZY | RTLD_GLOBAL);
  int (*count)(void);
  int (*open_arm)(int);
  double before, after;
  int listed, opened;
  if (phantom == NULL) return 2;
  count = (int (*)(void))dlsym(phantom, "hdPhantomGetNumDevices");
  open_arm = (int (*)(int))dlsym(phantom, "hdPhantomOpen");
  if (count == NULL || open_arm == NULL) return 2;
  if (dhdGetDeviceCount() != 1) return 3;
  if (argc > 1 && strcmp(argv[1], "refused") == 0) return drdOpenID(0) == -1 ? 0 : 4;
  if (drdOpenID(0) != 0 || dhdEnableForce(DHD_ON, 0) != 0) return 4;
  before = sent_after(500);
  listed = count();
  opened = open_arm(0);
  if (argc > 1) {
    char command[4096];
    snprintf(command, sizeof command, "%s refused", argv[0]);
    if (system(command) != 0) return 5;
  }
  after = sent_after(500);
  printf("listed again %d, opened %d, %.3f N before, %.3f N after\n", listed, opened, before, after);
  dhdClose(0);
  return listed == 0 && opened == -1 && fabs(after - kForce) < 1e-3 && fabs(before - kForce) < 1e-3
             ? 0
             : 6;
}
