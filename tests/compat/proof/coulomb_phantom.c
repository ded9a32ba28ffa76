/* The charge in the style of CHAI3D. */
#include "../clients/force_laws.h"
#include "../clients/load_phantom.h"
#include "proof.h"

int main(int argc, char** argv) {
  Phantom phantom;
  double p[3], f[3];
  int tick;
  proof_begin(argc, argv);
  PROOF(load_phantom(&phantom) && phantom.count() == 1 && phantom.open_arm(0) != -1);
  for (tick = 0; tick < kProofTicks; ++tick) {
    PROOF(phantom.position(0, &p[0], &p[1], &p[2]) == 1);
    coulomb_force(0.8, 0.012, p, f);
    proof_note(0, p, f);
    PROOF(push_phantom(&phantom, 0, f));
  }
  PROOF(phantom.close_arm(0) == 1);
  return proof_end();
}
