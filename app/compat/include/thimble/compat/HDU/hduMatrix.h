#pragma once

/* 4 x 4 transform for programs written for HDAPI. */

#include <HDU/hduVector.h>

/** Transform in the layout of HD_CURRENT_TRANSFORM: the translation is the last row. */
class hduMatrix {
 public:
  /** Constructs the identity. */
  hduMatrix() {
    for (int i = 0; i < 16; ++i) values_[i / 4][i % 4] = i % 5 == 0 ? 1.0 : 0.0;
  }
  /** Constructs a transform from 16 numbers in the order of HD_CURRENT_TRANSFORM. */
  explicit hduMatrix(const double* values) {
    for (int i = 0; i < 16; ++i) values_[i / 4][i % 4] = values[i];
  }

  operator double*() { return &values_[0][0]; }
  operator const double*() const { return &values_[0][0]; }
  double* operator[](int row) { return values_[row]; }
  const double* operator[](int row) const { return values_[row]; }

  /** Returns the transformed point. */
  hduVector3Dd multVecMatrix(const hduVector3Dd& p) const {
    hduVector3Dd q;
    for (int i = 0; i < 3; ++i) {
      q[i] = p[0] * values_[0][i] + p[1] * values_[1][i] + p[2] * values_[2][i] + values_[3][i];
    }
    return q;
  }
  /** Returns the transformed direction. */
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
