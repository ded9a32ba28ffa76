#include "counting/counting.h"

// Every mutant is killed except `>=`, which is equivalent.
int limited(int x, int max) {
  if (x > max) return max;
  return x;
}

// Hangs without `++i`.
int counted(int n) {
  int i = 0;
  while (i < n) ++i;
  return i;
}

// The mutant `begin + end` does not compile.
long length(const char* begin, const char* end) {
  return end - begin;
}

// Called by a test without an expectation.
int doubled(int x) {
  return x + x;
}

// Called by no test.
int tripled(int x) {
  return x + 2;
}
