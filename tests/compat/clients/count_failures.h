/* Checks of client programs that continue after a failed one. */
#ifndef COUNT_FAILURES_H
#define COUNT_FAILURES_H

#include <stdio.h>

static int failures;
#define CHECK(condition)                             \
  do {                                               \
    if (!(condition)) {                              \
      printf("line %d: %s\n", __LINE__, #condition); \
      ++failures;                                    \
    }                                                \
  } while (0)

#endif
