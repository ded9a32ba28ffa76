/* Initialises the arm by motion, as the examples of DRD do, then leaves regulation and pushes. */
#include <drdc.h>

#include "../clients/force_laws.h"
#include "proof.h"

int main(int argc, char** argv) {
  const double origin[3] = {0, 0, 0};
  double p[3], f[3];
  int tick;
  proof_begin(argc, argv);
  PROOF(drdOpen() >= 0 && drdIsSupported(-1));
  if (!drdIsInitialized(-1)) PROOF(drdAutoInit(-1) >= 0);
  PROOF(drdIsInitialized(-1));
  PROOF(drdStart(-1) >= 0 && drdMoveToPos(0.01, 0, 0, true, -1) >= 0);
  PROOF(dhdGetPosition(&p[0], &p[1], &p[2], -1) >= 0);
  PROOF(fabs(p[0] - 0.01) < 0.002 && fabs(p[1]) < 0.002 && fabs(p[2]) < 0.002);
  PROOF(drdStop(true, -1) >= 0);
  for (tick = 0; tick < kProofTicks; ++tick) {
    PROOF(dhdGetPosition(&p[0], &p[1], &p[2], -1) >= 0);
    spring_force(25, origin, p, f);
    proof_note(0, p, f);
    PROOF(dhdSetForce(f[0], f[1], f[2], -1) >= 0);
  }
  PROOF(drdClose(-1) >= 0);
  return proof_end();
}
