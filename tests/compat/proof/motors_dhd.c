/* Pushes with a constant force while it reads the status. */
#include <dhdc.h>

#include "proof.h"

int main(int argc, char** argv) {
  const double f[3] = {-0.1, 0.3, 0.2};
  double p[3];
  int tick, saturated = 0, status[DHD_MAX_STATUS];
  proof_begin(argc, argv);
  PROOF(dhdOpen() == 0 && dhdEnableForce(DHD_ON, -1) == 0);
  PROOF(dhdSetBrakes(DHD_OFF, -1) == 0);
  for (tick = 0; tick < kProofTicks; ++tick) {
    PROOF(dhdGetPosition(&p[0], &p[1], &p[2], -1) >= 0);
    proof_note(0, p, f);
    switch (dhdSetForceAndGripperForce(f[0], f[1], f[2], 0, -1)) {
      case 0:
        break;
      case DHD_MOTOR_SATURATED:
        ++saturated;
        break;
      default:
        PROOF(!"the force was refused");
    }
    PROOF(dhdGetStatus(status, -1) == 0);
    PROOF(status[DHD_STATUS_CONNECTED] == 1 && status[DHD_STATUS_FORCE] == 1);
    PROOF(status[DHD_STATUS_ERROR] == 0 && status[DHD_STATUS_FORCE_OFF_CAUSE] == 0);
  }
  PROOF(saturated == 0 && dhdStop(-1) == 0 && dhdClose(-1) == 0);
  return proof_end();
}
