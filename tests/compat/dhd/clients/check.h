/* What the clients check is told on standard output; the first thing that is wrong ends them. */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "drdc.h"

#define CHECK(condition)                                                               \
  do {                                                                                 \
    if (!(condition)) {                                                                \
      printf("WRONG: %s (line %d): %s\n", #condition, __LINE__, dhdErrorGetLastStr()); \
      exit(1);                                                                         \
    }                                                                                  \
  } while (0)

/* Two numbers that a step of an encoder or of a motor may part. */
#define CHECK_NEAR(a, b, quantum) CHECK(fabs((a) - (b)) < (quantum))

/* Opens an arm and lets forces through. */
#define OPEN_ARM(id)                        \
  do {                                      \
    CHECK(dhdOpenID(id) == (id));           \
    CHECK(dhdEnableForce(DHD_ON, id) == 0); \
  } while (0)

#endif
