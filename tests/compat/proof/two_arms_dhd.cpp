// Two arms in one loop, each with its own spring.
#include <dhdc.h>

#include "../clients/force_laws.h"
#include "proof.h"

int main(int argc, char** argv) {
  proof_begin(argc, argv);
  const int count = dhdGetDeviceCount();
  PROOF(count == 2);
  for (int arm = 0; arm < count; ++arm) {
    PROOF(dhdOpenID(static_cast<char>(arm)) == arm);
    PROOF(dhdGetSystemName(static_cast<char>(arm)) != nullptr);
    PROOF(dhdEnableForce(DHD_ON, static_cast<char>(arm)) == 0);
  }
  const double origin[3] = {0, 0, 0};
  for (int tick = 0; tick < kProofTicks; ++tick) {
    for (int arm = 0; arm < count; ++arm) {
      const char id = static_cast<char>(arm);
      double p[3], f[3];
      PROOF(dhdGetPosition(&p[0], &p[1], &p[2], id) >= 0);
      spring_force(15 + 10 * arm, origin, p, f);
      proof_note(arm, p, f);
      PROOF(dhdSetForceAndTorqueAndGripperForce(f[0], f[1], f[2], 0, 0, 0, 0, id) >= 0);
    }
  }
  for (int arm = 0; arm < count; ++arm) PROOF(dhdClose(static_cast<char>(arm)) == 0);
  return proof_end();
}
