/* A plane at 18 mm by DHD, with a vibration that is off. */
#include <dhdc.h>

#include "../clients/force_laws.h"
#include "proof.h"

int main(int argc, char** argv) {
  double p[3], f[3];
  int tick, touched = 0;
  proof_begin(argc, argv);
  PROOF(dhdOpen() >= 0 && dhdSetGravityCompensation(DHD_ON, -1) >= 0);
  PROOF(dhdEnableForce(DHD_ON, -1) >= 0 && dhdSetVibration(0, 0, 0, -1) >= 0);
  for (tick = 0; tick < kProofTicks; ++tick) {
    PROOF(dhdGetPosition(&p[0], &p[1], &p[2], -1) >= 0);
    plane_force(150, 0.018, 2, p, f);
    proof_note(0, p, f);
    PROOF(dhdSetForce(f[0], f[1], f[2], -1) >= 0);
    if (f[2] > 0) ++touched;
  }
  PROOF(touched > 300 && dhdClose(-1) >= 0);
  return proof_end();
}
