// Calls of DHD and DRD as C++ programs write them: with default arguments, and with functions that
// are not answered. Returns 0 without an arm, too.
#include <drdc.h>

#include <cstdio>

int main() {
  static_assert(DHD_THREAD_PRIORITY_DEFAULT == 0 && DHD_THREAD_PRIORITY_HIGH == 1 &&
                DHD_THREAD_PRIORITY_LOW == 2);
  static_assert(DHD_DEVICE_SIGMA33P == 106 && DHD_DEVICE_OMEGA331_LEFT == 37);
  const bool opened = drdOpen() >= 0;
  if (opened) {
    dhdSetBrakes();
    dhdSetGravityCompensation();
    dhdWaitForReset();
    dhdSetVibration(0, 0);
    drdStart();
    drdMoveToPos(0.01, 0, 0);
    drdStop();
  }
  unsigned char mask = 0;
  if (drdLock(mask, true) != -1 || dhdErrorGetLast() != DHD_ERROR_NOT_IMPLEMENTED) return 2;
  if (dhdGetMaxTorque() != -1.0) return 3;
  const bool good = !opened || dhdErrorGetLast() == DHD_ERROR_NOT_IMPLEMENTED;
  if (opened) drdClose();
  std::printf("headers: %s\n", good ? "PASSED" : "FAILED");
  return good ? 0 : 1;
}
