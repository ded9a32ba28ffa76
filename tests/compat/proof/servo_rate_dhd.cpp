// Measures the rate of its loop, which only the set-force call paces, against that of the library.
#include <drdc.h>

#include "../clients/force_laws.h"
#include "proof.h"

int main(int argc, char** argv) {
  proof_begin(argc, argv);
  PROOF(drdOpen() == 0 && drdIsSupported() && dhdEnableForce(DHD_ON) == 0);
  const double origin[3] = {0, 0, 0};
  double reported = 0;
  const double begin = drdGetTime();
  for (int tick = 0; tick < kProofTicks; ++tick) {
    double p[3], f[3];
    PROOF(dhdGetPosition(&p[0], &p[1], &p[2]) >= 0);
    spring_force(25, origin, p, f);
    proof_note(0, p, f);
    PROOF(dhdSetForce(f[0], f[1], f[2]) >= 0);
    reported = dhdGetComFreq();
  }
  const double rate = kProofTicks / (drdGetTime() - begin);  // Hz
  printf("%.1f Hz measured, %.3f kHz reported\n", rate, reported);
  PROOF(fabs(rate / 1000 - 1) < 0.01 && fabs(reported - 1) < 0.01);
  PROOF(drdClose() == 0);
  return proof_end();
}
