#pragma once

/* 4 x 4 transform for C++ programs written for HDAPI. */

#include <HDU/hduVector.h>

#include <cmath>

/** Transform in the layout of HD_CURRENT_TRANSFORM: points are rows, the translation is the last
 * row, and `a * b` applies a first. */
class hduMatrix {
 public:
  /** Constructs the identity. */
  hduMatrix() { makeIdentity(); }
  /** Constructs a transform from 16 numbers in the order of HD_CURRENT_TRANSFORM. */
  explicit hduMatrix(const double* values) {
    for (int i = 0; i < 16; ++i) values_[i / 4][i % 4] = values[i];
  }
  explicit hduMatrix(const float* values) {
    for (int i = 0; i < 16; ++i) values_[i / 4][i % 4] = static_cast<double>(values[i]);
  }
  explicit hduMatrix(const double values[4][4]) : hduMatrix(&values[0][0]) {}
  /** Constructs a transform from 16 numbers, row by row. */
  hduMatrix(double a00, double a01, double a02, double a03, double a10, double a11, double a12,
            double a13, double a20, double a21, double a22, double a23, double a30, double a31,
            double a32, double a33)
      : values_{{a00, a01, a02, a03},
                {a10, a11, a12, a13},
                {a20, a21, a22, a23},
                {a30, a31, a32, a33}} {}

  operator double*() { return &values_[0][0]; }
  operator const double*() const { return &values_[0][0]; }
  double* operator[](int row) { return values_[row]; }
  const double* operator[](int row) const { return values_[row]; }
  double& operator()(int row, int column) { return values_[row][column]; }
  double operator()(int row, int column) const { return values_[row][column]; }
  double get(int row, int column) const { return values_[row][column]; }
  void set(int row, int column, double value) { values_[row][column] = value; }
  void get(double values[4][4]) const {
    for (int i = 0; i < 16; ++i) values[i / 4][i % 4] = values_[i / 4][i % 4];
  }
  void set(const double values[4][4]) { *this = hduMatrix(values); }
  void makeIdentity() {
    for (int i = 0; i < 16; ++i) values_[i / 4][i % 4] = i % 5 == 0 ? 1.0 : 0.0;
  }

  /** Applies another transform after this one, or before it. */
  hduMatrix& multRight(const hduMatrix& after) { return *this = *this * after; }
  hduMatrix& multLeft(const hduMatrix& before) { return *this = before * *this; }
  friend hduMatrix operator*(const hduMatrix& a, const hduMatrix& b) {
    hduMatrix product;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        product.values_[i][j] = 0;
        for (int k = 0; k < 4; ++k) product.values_[i][j] += a.values_[i][k] * b.values_[k][j];
      }
    }
    return product;
  }
  friend hduVector3Dd operator*(const hduVector3Dd& p, const hduMatrix& m) {
    return m.multVecMatrix(p);
  }

  hduMatrix getTranspose() const {
    hduMatrix transposed;
    for (int i = 0; i < 16; ++i) transposed.values_[i % 4][i / 4] = values_[i / 4][i % 4];
    return transposed;
  }
  void transpose() { *this = getTranspose(); }
  /** Returns the inverse, by Gauss' method; sets `*success` if it is given. A transform without an
   * inverse is returned unchanged. */
  hduMatrix getInverse(bool* success = nullptr) const {
    hduMatrix left = *this, inverse;
    bool good = true;
    for (int column = 0; column < 4 && good; ++column) {
      int pivot = column;
      for (int row = column + 1; row < 4; ++row) {
        if (std::fabs(left[row][column]) > std::fabs(left[pivot][column])) pivot = row;
      }
      good = left[pivot][column] != 0;
      const double factor = good ? 1 / left[pivot][column] : 1;
      for (int k = 0; k < 4; ++k) {
        const double l = left[pivot][k], i = inverse[pivot][k];
        left[pivot][k] = left[column][k], inverse[pivot][k] = inverse[column][k];
        left[column][k] = l * factor, inverse[column][k] = i * factor;
      }
      for (int row = 0; row < 4; ++row) {
        const double multiple = row == column ? 0 : left[row][column];
        for (int k = 0; k < 4; ++k) {
          left[row][k] -= multiple * left[column][k];
          inverse[row][k] -= multiple * inverse[column][k];
        }
      }
    }
    if (success != nullptr) *success = good;
    return good ? inverse : *this;
  }
  bool invert() {
    bool good = false;
    *this = getInverse(&good);
    return good;
  }
  /** Writes the rotation, without translation and scale, to a transform. */
  void getRotationMatrix(hduMatrix& rotation) const {
    hduMatrix turned;
    for (int row = 0; row < 3; ++row) {
      hduVector3Dd axis(values_[row][0], values_[row][1], values_[row][2]);
      axis.normalize();
      for (int k = 0; k < 3; ++k) turned.values_[row][k] = axis[k];
    }
    rotation = turned;
  }

  static hduMatrix createTranslation(double x, double y, double z) {
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
  }
  static hduMatrix createTranslation(const hduVector3Dd& v) {
    return createTranslation(v[0], v[1], v[2]);
  }
  static hduMatrix createScale(double x, double y, double z) {
    return {x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1};
  }
  static hduMatrix createScale(const hduVector3Dd& s) { return createScale(s[0], s[1], s[2]); }
  /** Returns the right-handed rotation by an angle (rad) about an axis [Rodrigues]. */
  static hduMatrix createRotation(hduVector3Dd axis, double angle) {
    axis.normalize();
    const double c = std::cos(angle), s = std::sin(angle);
    hduMatrix rotation;
    for (int i = 0; i < 9; ++i) {
      rotation[i / 3][i % 3] = (i % 4 == 0 ? c : 0) + (1 - c) * axis[i / 3] * axis[i % 3];
    }
    for (int row = 0; row < 3; ++row) {
      const int next = (row + 1) % 3, last = (row + 2) % 3;
      rotation[row][next] += s * axis[last];
      rotation[next][row] -= s * axis[last];
    }
    return rotation;
  }
  static hduMatrix createRotation(double x, double y, double z, double angle) {
    return createRotation(hduVector3Dd(x, y, z), angle);
  }
  static hduMatrix createRotationAroundX(double angle) { return createRotation(1, 0, 0, angle); }
  static hduMatrix createRotationAroundY(double angle) { return createRotation(0, 1, 0, angle); }
  static hduMatrix createRotationAroundZ(double angle) { return createRotation(0, 0, 1, angle); }

  /** Returns the transformed point. */
  hduVector3Dd multVecMatrix(const hduVector3Dd& p) const {
    hduVector3Dd q = multDirMatrix(p);
    for (int i = 0; i < 3; ++i) q[i] += values_[3][i];
    return q;
  }
  void multVecMatrix(const hduVector3Dd& p, hduVector3Dd& to) const { to = multVecMatrix(p); }
  /** Returns the transformed direction. */
  hduVector3Dd multDirMatrix(const hduVector3Dd& d) const {
    hduVector3Dd q;
    for (int i = 0; i < 3; ++i) {
      q[i] = d[0] * values_[0][i] + d[1] * values_[1][i] + d[2] * values_[2][i];
    }
    return q;
  }
  void multDirMatrix(const hduVector3Dd& d, hduVector3Dd& to) const { to = multDirMatrix(d); }

  friend std::ostream& operator<<(std::ostream& to, const hduMatrix& m) {
    for (int i = 0; i < 16; ++i) to << m.values_[i / 4][i % 4] << (i % 4 == 3 ? '\n' : ' ');
    return to;
  }

 private:
  double values_[4][4];
};
