/* Makes wrong calls in its loop; each returns -1 with the error of the API, and the forces of the
 * other calls arrive. */
#include <dhdc.h>

#include "../clients/force_laws.h"
#include "proof.h"

int main(int argc, char** argv) {
  const double origin[3] = {0, 0, 0};
  double p[3], f[3];
  int tick;
  proof_begin(argc, argv);
  PROOF(dhdSetForce(1, 0, 0, 0) == -1 && dhdErrorGetLast() == DHD_ERROR_DEVICE_NOT_READY);
  PROOF(dhdOpenID(3) == -1);
  PROOF(dhdOpenID(0) == 0 && dhdEnableForce(DHD_ON, 0) == 0);
  for (tick = 0; tick < kProofTicks; ++tick) {
    PROOF(dhdGetPosition(&p[0], &p[1], &p[2], 0) >= 0);
    spring_force(20, origin, p, f);
    proof_note(0, p, f);
    PROOF(dhdSetForce(f[0], f[1], f[2], 0) >= 0);
    if (tick % 100) continue;
    PROOF(dhdGetPosition(NULL, &p[1], &p[2], 0) == -1);
    PROOF(dhdErrorGetLast() == DHD_ERROR_NULL_ARGUMENT && dhdErrorGetLastStr()[0] != 0);
    PROOF(dhdSetForce(0.1, 0, 0, 2) == -1 && dhdSetWatchdog(10, 0) == -1);
    PROOF(dhdErrorGetLast() == DHD_ERROR_EXPERT_MODE_DISABLED);
    PROOF(dhdGetGripperGap(&p[0], 0) == -1);
  }
  PROOF(dhdClose(0) == 0 && dhdClose(0) == -1);
  return proof_end();
}
