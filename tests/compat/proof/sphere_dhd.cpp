// The sphere with DRD's opening and DHD's forces.
#include <drdc.h>

#include "../clients/force_laws.h"
#include "proof.h"

int main(int argc, char** argv) {
  proof_begin(argc, argv);
  if (drdOpen() < 0) {
    fprintf(stderr, "no arm: %s\n", dhdErrorGetLastStr());
    return 2;
  }
  PROOF(dhdEnableForce(DHD_ON) >= 0);
  const Sphere sphere = {{0, 0, 0}, 0.020, 250};  // m, N/m
  double deepest = 0;
  for (int tick = 0; tick < kProofTicks; ++tick) {
    double p[3], f[3], grip[3];
    PROOF(dhdGetPosition(&p[0], &p[1], &p[2]) >= 0);
    if (dhdHasGripper()) PROOF(dhdGetGripperThumbPos(&grip[0], &grip[1], &grip[2]) >= 0);
    deepest = fmax(deepest, sphere_force(&sphere, p, f));
    proof_note(0, p, f);
    PROOF(dhdSetForceAndTorque(f[0], f[1], f[2], 0, 0, 0) >= 0);
  }
  PROOF(deepest > 0.002 && drdClose() >= 0);
  return proof_end();
}
