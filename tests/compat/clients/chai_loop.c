/* Behaves like a CHAI3D program: loads both libraries at run time by their bare names. Only the
 * set-force call paces its loop, of 1000 turns or of the given number. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "load_phantom.h"

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char** argv) {
  const int turns = argc > 1 ? atoi(argv[1]) : 1000;
  void* hd = dlopen("libHD.so", RTLD_LAZY | RTLD_GLOBAL);
  Phantom phantom;
  double began, seconds, p[3], f[3];
  int i, k;
  if (!hd || !load_phantom(&phantom)) return 2;
  if (phantom.count() < 1) return 3;
  phantom.open_arm(0);
  began = now();
  for (i = 0; i < turns; ++i) {
    if (!phantom.position(0, &p[0], &p[1], &p[2])) return 4;
    for (k = 0; k < 3; ++k) f[k] = -20 * p[k];
    if (!push_phantom(&phantom, 0, f)) return 5;
  }
  seconds = now() - began;
  phantom.close_arm(0);
  printf("%d turns in %.3f s\n", turns, seconds);
  return seconds > 0.99e-3 * turns ? 0 : 6;
}
