/* Checks of the client programs. The first failed check is printed and ends the program. */
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

/* Compares two numbers that may differ by a step of an encoder or motor. */
#define CHECK_NEAR(a, b, quantum) CHECK(fabs((a) - (b)) < (quantum))

/* Opens an arm and enables its force. */
#define OPEN_ARM(id)                        \
  do {                                      \
    CHECK(dhdOpenID(id) == (id));           \
    CHECK(dhdEnableForce(DHD_ON, id) == 0); \
  } while (0)

#endif
