/* A sphere of 20 mm that pushes the tip out. */
#include "../../clients/client_sphere.h"

#include "check.h"

int main(int argc, char** argv) {
  static Sphere sphere = {{0, 0, 0}, 0.020, 250}; /* m, N/m */
  static ForceLog asked;
  const SphereChoice choice = sphere_choice(argc, argv, &sphere, &asked);
  double p[3], f[3], deepest = 0;
  int turn;
  OPEN_ARM(0);
  for (turn = 0; turn < 1000 * choice.seconds; ++turn) {
    double depth;
    CHECK(dhdGetPosition(&p[0], &p[1], &p[2], -1) >= 0);
    depth = sphere_force(&sphere, p, f);
    if (depth > deepest) deepest = depth;
    log_force(&asked, f);
    CHECK(dhdSetForce(f[0], f[1], f[2], -1) >= 0);
  }
  CHECK(dhdClose(-1) == 0);
  printf("%d turns, %.2f mm deep\n", turn, 1000 * deepest);
  CHECK(deepest > 0.001);
  CHECK(write_forces(&asked, choice.log_file) == 0);
  printf("sphere: PASSED\n");
  return 0;
}
