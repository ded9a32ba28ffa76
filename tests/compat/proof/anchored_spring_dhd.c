/* A spring at the place where the arm is when it is opened, with damping. */
#include <dhdc.h>

#include "../clients/force_laws.h"
#include "proof.h"

int main(int argc, char** argv) {
  const double stiffness = 40, damping = 1; /* N/m, N s/m */
  double anchor[3], p[3], v[3], f[3];
  int tick, i, major, minor, release, revision;
  proof_begin(argc, argv);
  dhdGetSDKVersion(&major, &minor, &release, &revision);
  if (dhdOpen() < 0) {
    fprintf(stderr, "no arm: %s\n", dhdErrorGetLastStr());
    return 2;
  }
  PROOF(dhdGetSystemName(-1) != NULL);
  PROOF(dhdGetPosition(&anchor[0], &anchor[1], &anchor[2], -1) >= 0);
  PROOF(dhdEnableForce(DHD_ON, -1) >= 0);
  for (tick = 0; tick < kProofTicks && !dhdGetButton(0, -1); ++tick) {
    PROOF(dhdGetPosition(&p[0], &p[1], &p[2], -1) >= 0);
    PROOF(dhdGetLinearVelocity(&v[0], &v[1], &v[2], -1) >= 0);
    spring_force(stiffness, anchor, p, f);
    for (i = 0; i < 3; ++i) f[i] -= damping * v[i];
    proof_note(0, p, f);
    PROOF(dhdSetForceAndTorqueAndGripperForce(f[0], f[1], f[2], 0, 0, 0, 0, -1) >= 0);
  }
  PROOF(dhdClose(-1) >= 0);
  return proof_end();
}
