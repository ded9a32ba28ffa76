#pragma once

/* Rotations as quaternions for C++ programs written for HDAPI. */

#include <HDU/hduMatrix.h>
#include <HDU/hduVector.h>

#include <cmath>

/** A quaternion s + v. */
class hduQuaternion {
 public:
  /** Constructs the identity. */
  hduQuaternion() : s_(1) {}
  hduQuaternion(double s, const hduVector3Dd& v) : s_(s), v_(v) {}
  hduQuaternion(double s, double x, double y, double z) : s_(s), v_(x, y, z) {}
  /** Constructs the rotation by an angle (rad) about an axis. */
  hduQuaternion(const hduVector3Dd& axis, double angle)
      : s_(std::cos(angle / 2)), v_(::normalize(axis) * std::sin(angle / 2)) {}
  /** Constructs the rotation of a transform. */
  explicit hduQuaternion(const hduMatrix& m) {
    hduMatrix r;
    m.getRotationMatrix(r);
    // The largest of the four components is found first, so that no division is by a small number.
    const double trace = r[0][0] + r[1][1] + r[2][2];
    int largest = 0;
    for (int i = 1; i < 3; ++i) {
      if (r[i][i] > r[largest][largest]) largest = i;
    }
    if (trace > r[largest][largest]) {
      const double twice = std::sqrt(1 + trace);
      s_ = twice / 2;
      v_.set((r[1][2] - r[2][1]) / (2 * twice), (r[2][0] - r[0][2]) / (2 * twice),
             (r[0][1] - r[1][0]) / (2 * twice));
      return;
    }
    const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
    const double twice = std::sqrt(1 + r[i][i] - r[j][j] - r[k][k]);
    v_[i] = twice / 2;
    v_[j] = (r[i][j] + r[j][i]) / (2 * twice);
    v_[k] = (r[i][k] + r[k][i]) / (2 * twice);
    s_ = (r[j][k] - r[k][j]) / (2 * twice);
  }

  double s() const { return s_; }
  double& s() { return s_; }
  const hduVector3Dd& v() const { return v_; }
  hduVector3Dd& v() { return v_; }

  double magnitude() const { return std::sqrt(s_ * s_ + v_.dotProduct(v_)); }
  /** Normalizes to length 1; a zero quaternion is unchanged. */
  void normalize() {
    const double length = magnitude();
    if (length > 0) *this = hduQuaternion(s_ / length, v_ / length);
  }
  hduQuaternion conjugate() const { return {s_, -v_}; }
  /** Returns the rotation as a transform. */
  hduMatrix getRotationMatrix() const {
    hduMatrix m;
    toRotationMatrix(m);
    return m;
  }
  void toRotationMatrix(hduMatrix& m) const {
    const double angle = 2 * std::atan2(v_.magnitude(), s_);
    m = hduMatrix::createRotation(v_, angle);
  }
  friend hduQuaternion operator*(const hduQuaternion& a, const hduQuaternion& b) {
    return {a.s_ * b.s_ - a.v_.dotProduct(b.v_),
            b.v_ * a.s_ + a.v_ * b.s_ + a.v_.crossProduct(b.v_)};
  }
  friend std::ostream& operator<<(std::ostream& to, const hduQuaternion& q) {
    return to << '(' << q.s_ << ", " << q.v_ << ')';
  }

 private:
  double s_;
  hduVector3Dd v_;
};
