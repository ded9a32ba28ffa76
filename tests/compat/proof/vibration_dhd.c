/* A vibration of 20 Hz to the side, by a program that has only its own declarations. */
#include "proof.h"

extern int dhdGetDeviceCount(void);
extern int dhdOpenID(char index);
extern int dhdClose(char id);
extern int dhdEnableForce(unsigned char on, char id);
extern int dhdGetPosition(double* x, double* y, double* z, char id);
extern int dhdSetForce(double x, double y, double z, char id);
extern double dhdGetTime(void);

int main(int argc, char** argv) {
  double p[3], f[3] = {0, 0, 0}, begin;
  int tick;
  proof_begin(argc, argv);
  PROOF(dhdGetDeviceCount() >= 1 && dhdOpenID(0) == 0 && dhdEnableForce(1, 0) == 0);
  begin = dhdGetTime();
  for (tick = 0; tick < kProofTicks; ++tick) {
    PROOF(dhdGetPosition(&p[0], &p[1], &p[2], 0) >= 0);
    f[1] = 0.4 * sin(2 * 3.14159265358979 * 20 * (dhdGetTime() - begin));
    proof_note(0, p, f);
    PROOF(dhdSetForce(f[0], f[1], f[2], 0) >= 0);
  }
  PROOF(dhdGetTime() - begin > 0.999e-3 * kProofTicks);
  PROOF(dhdClose(0) == 0);
  return proof_end();
}
