/* Waits until the hand, which follows the mouse, has moved the tip. Prints distance and direction.
 */
#include <HD/hd.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? atof(argv[1]) : 10, far = 10; /* mm */
  double start[3], p[3] = {0, 0, 0}, moved = 0;
  int i, look;
  HHD device = hdInitDevice(HD_DEFAULT_DEVICE);
  if (device == HD_INVALID_HANDLE) return 2;
  hdGetDoublev(HD_CURRENT_POSITION, start);
  printf("ready\n");
  fflush(stdout);
  for (look = 0; look < 100 * seconds && moved < far; ++look) {
    usleep(10000);
    hdGetDoublev(HD_CURRENT_POSITION, p);
    for (moved = 0, i = 0; i < 3; ++i) moved += (p[i] - start[i]) * (p[i] - start[i]);
    moved = sqrt(moved);
  }
  printf("led %.1f mm: %.1f to the right, %.1f up, %.1f to the user\n", moved, p[0] - start[0],
         p[1] - start[1], p[2] - start[2]);
  fflush(stdout);
  if (moved >= far) usleep(10000000); /* time to take a picture */
  hdDisableDevice(device);
  return moved >= far ? 0 : 3;
}
