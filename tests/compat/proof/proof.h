/* Shared by the programs of this folder: the log of what a program read and requested. check.py
 * compares the log with the recording. A line of the log: arm, position (m), force (N), in the axes
 * of the recording (x to the user, y right, z up). */
#ifndef PROOF_H
#define PROOF_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const int kProofTicks = 1500; /* chosen: the path of the hand (hand.txt) takes as long */

static FILE* proof_log;

/* Opens the log, which is the program's first argument. */
static void proof_begin(int argc, char** argv) {
  proof_log = argc > 1 ? fopen(argv[1], "w") : NULL;
  if (proof_log == NULL) {
    fprintf(stderr, "%s: cannot write its log; the first argument is a file name\n", argv[0]);
    exit(2);
  }
}

/* Logs a position and a force, in m and N and the axes of the recording. */
static void proof_note(int arm, const double p[3], const double f[3]) {
  fprintf(proof_log, "%d %.17g %.17g %.17g %.17g %.17g %.17g\n", arm, p[0], p[1], p[2], f[0], f[1],
          f[2]);
}

/* Ends the program with an error if a condition does not hold. */
#define PROOF(condition)                                              \
  do {                                                                \
    if (!(condition)) {                                               \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
      exit(3);                                                        \
    }                                                                 \
  } while (0)

/* Closes the log; returns the exit code. */
static int proof_end(void) {
  return fclose(proof_log) == 0 ? 0 : 4;
}

#endif
