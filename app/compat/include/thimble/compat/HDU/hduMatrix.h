#pragma once

/* A transform of 4 x 4 numbers, as programs written for HDAPI use it. */

#include <HDU/hduVector.h>

/** A transform as HD_CURRENT_TRANSFORM gives it: the translation is its last row. */
class hduMatrix {
 public:
  /** The identity. */
  hduMatrix() {
    for (int i = 0; i < 16; ++i) values_[i / 4][i % 4] = i % 5 == 0 ? 1.0 : 0.0;
  }
  /** Takes 16 numbers in the order of HD_CURRENT_TRANSFORM. */
  explicit hduMatrix(const double* values) {
    for (int i = 0; i < 16; ++i) values_[i / 4][i % 4] = values[i];
  }

  operator double*() { return &values_[0][0]; }
  operator const double*() const { return &values_[0][0]; }
  double* operator[](int row) { return values_[row]; }
  const double* operator[](int row) const { return values_[row]; }

  /** Returns where a point comes to lie. */
  hduVector3Dd multVecMatrix(const hduVector3Dd& p) const {
    hduVector3Dd q;
    for (int i = 0; i < 3; ++i) {
      q[i] = p[0] * values_[0][i] + p[1] * values_[1][i] + p[2] * values_[2][i] + values_[3][i];
    }
    return q;
  }
  /** Returns what a direction becomes. */
  hduVector3Dd multDirMatrix(const hduVector3Dd& d) const {
    hduVector3Dd q;
    for (int i = 0; i < 3; ++i) {
      q[i] = d[0] * values_[0][i] + d[1] * values_[1][i] + d[2] * values_[2][i];
    }
    return q;
  }

 private:
  double values_[4][4];
};
