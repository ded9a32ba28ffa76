/* The same sphere in the style of CHAI3D: libhdPhantom is loaded at run time, and the set-force
 * call paces the loop. */
#include <dlfcn.h>
#include <stdio.h>

#include "client_sphere.h"

typedef int (*ById)(int);
typedef int (*Three)(int, double*, double*, double*);
typedef int (*Six)(int, const double*, const double*, const double*, const double*, const double*,
                   const double*);

int main(int argc, char** argv) {
  static Sphere sphere = {{0, 0, 0}, 0.020, 250}; /* m, N/m */
  static ForceLog asked;
  const SphereChoice choice = sphere_choice(argc, argv, &sphere, &asked);
  void* library = dlopen("libhdPhantom.so", RTLD_LAZY | RTLD_GLOBAL);
  ById open_arm, close_arm;
  Three position;
  Six force;
  double p[3], f[3], none = 0, deepest = 0;
  int turn;
  if (!library) return 2;
  *(void**)&open_arm = dlsym(library, "hdPhantomOpen");
  *(void**)&close_arm = dlsym(library, "hdPhantomClose");
  *(void**)&position = dlsym(library, "hdPhantomGetPosition");
  *(void**)&force = dlsym(library, "hdPhantomSetForceAndTorque");
  if (!open_arm || !close_arm || !position || !force || open_arm(0) != 0) return 3;
  for (turn = 0; turn < 1000 * choice.seconds; ++turn) {
    double depth;
    if (!position(0, &p[0], &p[1], &p[2])) return 4;
    depth = sphere_force(&sphere, p, f);
    if (depth > deepest) deepest = depth;
    log_force(&asked, f);
    if (force(0, &f[0], &f[1], &f[2], &none, &none, &none) == -1) return 5;
  }
  close_arm(0);
  printf("%d turns, %.2f mm deep\n", turn, 1000 * deepest);
  return write_forces(&asked, choice.log_file) || !(deepest > 0.001) ? 6 : 0;
}
