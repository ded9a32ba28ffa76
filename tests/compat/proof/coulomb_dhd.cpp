// The charge with DHD in C++, by default arguments.
#include <dhdc.h>

#include "../clients/force_laws.h"
#include "proof.h"

int main(int argc, char** argv) {
  proof_begin(argc, argv);
  PROOF(dhdGetDeviceCount() == 1 && dhdOpenID(0) == 0);
  PROOF(dhdEnableForce(DHD_ON) == DHD_NO_ERROR);
  for (int tick = 0; tick < kProofTicks; ++tick) {
    double p[3], f[3], rows[3][3];
    PROOF(dhdGetPositionAndOrientationFrame(&p[0], &p[1], &p[2], rows) >= 0);
    coulomb_force(0.8, 0.012, p, f);  // N, m
    proof_note(0, p, f);
    PROOF(dhdSetForceAndTorque(f[0], f[1], f[2], 0, 0, 0) >= DHD_NO_ERROR);
  }
  PROOF(dhdEnableForce(DHD_OFF) >= 0 && dhdClose() >= 0);
  return proof_end();
}
