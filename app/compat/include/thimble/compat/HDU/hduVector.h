#pragma once

/* Vector of three numbers for programs written for HDAPI: the most used part of HDU. */

#include <cmath>

/** Three numbers with the interface of an array and of a vector. */
template <class T>
class hduVector3 {
 public:
  hduVector3() : values_{0, 0, 0} {}
  hduVector3(T x, T y, T z) : values_{x, y, z} {}
  explicit hduVector3(const T* values) : values_{values[0], values[1], values[2]} {}

  operator T*() { return values_; }
  operator const T*() const { return values_; }
  T& operator[](int i) { return values_[i]; }
  const T& operator[](int i) const { return values_[i]; }
  void set(T x, T y, T z) { *this = hduVector3(x, y, z); }

  hduVector3& operator+=(const hduVector3& v) { return *this = *this + v; }
  hduVector3& operator-=(const hduVector3& v) { return *this = *this - v; }
  hduVector3& operator*=(T s) { return *this = *this * s; }
  hduVector3& operator/=(T s) { return *this = *this / s; }
  friend hduVector3 operator+(const hduVector3& a, const hduVector3& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  }
  friend hduVector3 operator-(const hduVector3& a, const hduVector3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  friend hduVector3 operator-(const hduVector3& a) { return {-a[0], -a[1], -a[2]}; }
  friend hduVector3 operator*(const hduVector3& a, T s) { return {a[0] * s, a[1] * s, a[2] * s}; }
  friend hduVector3 operator*(T s, const hduVector3& a) { return a * s; }
  friend hduVector3 operator/(const hduVector3& a, T s) { return {a[0] / s, a[1] / s, a[2] / s}; }

  T magnitude() const { return std::sqrt(dotProduct(*this)); }
  T dotProduct(const hduVector3& v) const {
    return values_[0] * v[0] + values_[1] * v[1] + values_[2] * v[2];
  }
  hduVector3 crossProduct(const hduVector3& v) const {
    return {values_[1] * v[2] - values_[2] * v[1], values_[2] * v[0] - values_[0] * v[2],
            values_[0] * v[1] - values_[1] * v[0]};
  }
  /** Normalises the vector to length 1; a zero vector is unchanged. */
  void normalize() {
    const T length = magnitude();
    if (length > 0) *this /= length;
  }

 private:
  T values_[3];
};

typedef hduVector3<double> hduVector3Dd;
typedef hduVector3<float> hduVector3Df;
