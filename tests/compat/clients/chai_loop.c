/* Behaves like a CHAI3D program: loads both libraries at run time by their bare names. Only the
 * set-force call paces its loop, of 1000 turns or of the given number. */
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef int (*Count)(void);
typedef int (*ById)(int);
typedef int (*Three)(int, double*, double*, double*);
typedef int (*Six)(int, const double*, const double*, const double*, const double*, const double*,
                   const double*);

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char** argv) {
  const int turns = argc > 1 ? atoi(argv[1]) : 1000;
  void* hd = dlopen("libHD.so", RTLD_LAZY | RTLD_GLOBAL);
  void* library = dlopen("libhdPhantom.so", RTLD_LAZY | RTLD_GLOBAL);
  Count count;
  ById open_arm, close_arm;
  Three position;
  Six force;
  double began, seconds, p[3], f[3], none = 0;
  int i, k;
  if (!hd || !library) return 2;
  *(void**)&count = dlsym(library, "hdPhantomGetNumDevices");
  *(void**)&open_arm = dlsym(library, "hdPhantomOpen");
  *(void**)&close_arm = dlsym(library, "hdPhantomClose");
  *(void**)&position = dlsym(library, "hdPhantomGetPosition");
  *(void**)&force = dlsym(library, "hdPhantomSetForceAndTorque");
  if (!count || !open_arm || !close_arm || !position || !force || count() < 1) return 3;
  open_arm(0);
  began = now();
  for (i = 0; i < turns; ++i) {
    if (!position(0, &p[0], &p[1], &p[2])) return 4;
    for (k = 0; k < 3; ++k) f[k] = -20 * p[k];
    if (force(0, &f[0], &f[1], &f[2], &none, &none, &none) == -1) return 5;
  }
  seconds = now() - began;
  close_arm(0);
  printf("%d turns in %.3f s\n", turns, seconds);
  return seconds > 0.99e-3 * turns ? 0 : 6;
}
