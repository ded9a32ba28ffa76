/* The same sphere in the style of CHAI3D: libhdPhantom is loaded at run time, and the set-force
 * call paces the loop. */
#include <stdio.h>

#include "client_sphere.h"
#include "load_phantom.h"

int main(int argc, char** argv) {
  static Sphere sphere = {{0, 0, 0}, 0.020, 250}; /* m, N/m */
  static ForceLog asked;
  const SphereChoice choice = sphere_choice(argc, argv, &sphere, &asked);
  Phantom phantom;
  double p[3], f[3], deepest = 0;
  int turn;
  if (!load_phantom(&phantom)) return 2;
  if (phantom.open_arm(0) != 0) return 3;
  for (turn = 0; turn < 1000 * choice.seconds; ++turn) {
    double depth;
    if (!phantom.position(0, &p[0], &p[1], &p[2])) return 4;
    depth = sphere_force(&sphere, p, f);
    if (depth > deepest) deepest = depth;
    log_force(&asked, f);
    if (!push_phantom(&phantom, 0, f)) return 5;
  }
  phantom.close_arm(0);
  printf("%d turns, %.2f mm deep\n", turn, 1000 * deepest);
  return write_forces(&asked, choice.log_file) || !(deepest > 0.001) ? 6 : 0;
}
