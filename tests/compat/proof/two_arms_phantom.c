/* Two arms in the style of CHAI3D, each with its own constant force. */
#include "../clients/load_phantom.h"
#include "proof.h"

int main(int argc, char** argv) {
  const double f[2][3] = {{0.3, 0, 0.1}, {0, -0.2, 0.1}};
  Phantom phantom;
  double p[3];
  int tick, arm;
  proof_begin(argc, argv);
  PROOF(load_phantom(&phantom) && phantom.count() == 2);
  for (arm = 0; arm < 2; ++arm) PROOF(phantom.open_arm(arm) != -1);
  for (tick = 0; tick < kProofTicks; ++tick) {
    for (arm = 0; arm < 2; ++arm) {
      PROOF(phantom.position(arm, &p[0], &p[1], &p[2]) != 0);
      proof_note(arm, p, f[arm]);
      PROOF(push_phantom(&phantom, arm, f[arm]));
    }
  }
  for (arm = 0; arm < 2; ++arm) PROOF(phantom.close_arm(arm) == 1);
  return proof_end();
}
