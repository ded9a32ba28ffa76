#pragma once

/* Small functions for programs written for HDAPI. For C and C++. */

#include <math.h>

#ifdef __cplusplus

/** Returns whether two numbers differ by at most `tolerance`. */
template <class T>
inline bool hduIsEqual(T a, T b, T tolerance) {
  return (a < b ? b - a : a - b) <= tolerance;
}
template <class T>
inline T hduMin(T a, T b) {
  return b < a ? b : a;
}
template <class T>
inline T hduMax(T a, T b) {
  return a < b ? b : a;
}
template <class T>
inline T hduSqr(T a) {
  return a * a;
}
/** Returns the point between two numbers at fraction `t` of the way from `a`. */
template <class T>
inline T hduLerp(T a, T b, T t) {
  return a + t * (b - a);
}

#else

/** Returns whether two numbers differ by at most `tolerance`. */
static inline int hduIsEqual(double a, double b, double tolerance) {
  return fabs(a - b) <= tolerance;
}
static inline double hduMin(double a, double b) {
  return b < a ? b : a;
}
static inline double hduMax(double a, double b) {
  return a < b ? b : a;
}
static inline double hduSqr(double a) {
  return a * a;
}

#endif
