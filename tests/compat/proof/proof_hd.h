/* For programs of HDAPI: mm, and x right, y up, z to the user. */
#ifndef PROOF_HD_H
#define PROOF_HD_H

#include "proof.h"

static void proof_note_hd(int arm, const double p[3], const double f[3]) {
  const double p_W[3] = {1e-3 * p[2], 1e-3 * p[0], 1e-3 * p[1]};
  const double f_W[3] = {f[2], f[0], f[1]};
  proof_note(arm, p_W, f_W);
}

#endif
