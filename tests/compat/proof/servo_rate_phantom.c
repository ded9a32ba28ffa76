/* Renders in turns of five readings, as CHAI3D does, and one force. */
#include "../clients/force_laws.h"
#include "../clients/load_phantom.h"
#include "proof.h"

int main(int argc, char** argv) {
  const double origin[3] = {0, 0, 0};
  Phantom phantom;
  double p[3], f[3];
  int tick, i;
  proof_begin(argc, argv);
  PROOF(load_phantom(&phantom) && phantom.count() >= 1 && phantom.open_arm(0) != -1);
  for (tick = 0; tick < kProofTicks; ++tick) {
    PROOF(phantom.position(0, &p[0], &p[1], &p[2]) != 0);
    for (i = 0; i < 5; ++i) PROOF(phantom.buttons(0) == 0);
    spring_force(25, origin, p, f);
    proof_note(0, p, f);
    PROOF(push_phantom(&phantom, 0, f));
  }
  PROOF(phantom.close_arm(0) != -1);
  return proof_end();
}
