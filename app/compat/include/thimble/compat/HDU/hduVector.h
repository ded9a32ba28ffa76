#pragma once

/* Vectors of three numbers for programs written for HDAPI. In C they are arrays; in C++ they are
 * classes that convert to arrays. The functions hduVec... take either. */

#include <math.h>

/* Functions on arrays of three numbers. A result may be one of the arguments. */
#define THIMBLE_HDU_VECTOR_FUNCTIONS(T)                                       \
  static inline void hduVecSet(T* v, T x, T y, T z) {                         \
    v[0] = x, v[1] = y, v[2] = z;                                             \
  }                                                                           \
  static inline void hduVecAdd(T* sum, const T* a, const T* b) {              \
    hduVecSet(sum, a[0] + b[0], a[1] + b[1], a[2] + b[2]);                    \
  }                                                                           \
  static inline void hduVecSubtract(T* difference, const T* a, const T* b) {  \
    hduVecSet(difference, a[0] - b[0], a[1] - b[1], a[2] - b[2]);             \
  }                                                                           \
  static inline void hduVecScale(T* scaled, const T* v, T factor) {           \
    hduVecSet(scaled, v[0] * factor, v[1] * factor, v[2] * factor);           \
  }                                                                           \
  static inline void hduVecAddInPlace(T* v, const T* b) {                     \
    hduVecAdd(v, v, b);                                                       \
  }                                                                           \
  static inline void hduVecSubtractInPlace(T* v, const T* b) {                \
    hduVecSubtract(v, v, b);                                                  \
  }                                                                           \
  static inline void hduVecScaleInPlace(T* v, T factor) {                     \
    hduVecScale(v, v, factor);                                                \
  }                                                                           \
  static inline T hduVecDotProduct(const T* a, const T* b) {                  \
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];                           \
  }                                                                           \
  static inline void hduVecCrossProduct(T* product, const T* a, const T* b) { \
    hduVecSet(product, a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],  \
              a[0] * b[1] - a[1] * b[0]);                                     \
  }                                                                           \
  static inline T hduVecMagnitude(const T* v) {                               \
    return (T)sqrt((double)hduVecDotProduct(v, v));                           \
  }                                                                           \
  static inline T hduVecDistance(const T* a, const T* b) {                    \
    T between[3];                                                             \
    hduVecSubtract(between, a, b);                                            \
    return hduVecMagnitude(between);                                          \
  }                                                                           \
  /* Normalizes to length 1; a zero vector is unchanged. */                   \
  static inline void hduVecNormalize(T* normalized, const T* v) {             \
    const T length = hduVecMagnitude(v);                                      \
    hduVecScale(normalized, v, length > 0 ? 1 / length : 1);                  \
  }                                                                           \
  static inline void hduVecNormalizeInPlace(T* v) {                           \
    hduVecNormalize(v, v);                                                    \
  }

#ifndef __cplusplus

typedef double hduVector3Dd[3];
typedef float hduVector3Df[3];

THIMBLE_HDU_VECTOR_FUNCTIONS(double)

#else

#include <ostream>

THIMBLE_HDU_VECTOR_FUNCTIONS(double)
THIMBLE_HDU_VECTOR_FUNCTIONS(float)

/** Three numbers with the interface of an array and of a vector. */
template <class T>
class hduVector3D {
 public:
  hduVector3D() : values_{0, 0, 0} {}
  hduVector3D(T x, T y, T z) : values_{x, y, z} {}
  explicit hduVector3D(const T* values) : values_{values[0], values[1], values[2]} {}
  template <class Other>
  explicit hduVector3D(const hduVector3D<Other>& v)
      : values_{static_cast<T>(v[0]), static_cast<T>(v[1]), static_cast<T>(v[2])} {}

  operator T*() { return values_; }
  operator const T*() const { return values_; }
  T& operator[](int i) { return values_[i]; }
  const T& operator[](int i) const { return values_[i]; }
  void set(T x, T y, T z) { *this = hduVector3D(x, y, z); }

  hduVector3D& operator+=(const hduVector3D& v) { return *this = *this + v; }
  hduVector3D& operator-=(const hduVector3D& v) { return *this = *this - v; }
  hduVector3D& operator*=(T s) { return *this = *this * s; }
  hduVector3D& operator/=(T s) { return *this = *this / s; }
  friend hduVector3D operator+(const hduVector3D& a, const hduVector3D& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  }
  friend hduVector3D operator-(const hduVector3D& a, const hduVector3D& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  friend hduVector3D operator-(const hduVector3D& a) { return {-a[0], -a[1], -a[2]}; }
  friend hduVector3D operator*(const hduVector3D& a, T s) { return {a[0] * s, a[1] * s, a[2] * s}; }
  friend hduVector3D operator*(T s, const hduVector3D& a) { return a * s; }
  friend hduVector3D operator/(const hduVector3D& a, T s) { return {a[0] / s, a[1] / s, a[2] / s}; }
  friend bool operator==(const hduVector3D& a, const hduVector3D& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
  }
  friend bool operator!=(const hduVector3D& a, const hduVector3D& b) { return !(a == b); }
  /** Writes "(x, y, z)". */
  friend std::ostream& operator<<(std::ostream& to, const hduVector3D& v) {
    return to << '(' << v[0] << ", " << v[1] << ", " << v[2] << ')';
  }

  T magnitude() const { return hduVecMagnitude(values_); }
  T distance(const hduVector3D& v) const { return hduVecDistance(values_, v.values_); }
  T dotProduct(const hduVector3D& v) const { return hduVecDotProduct(values_, v.values_); }
  hduVector3D crossProduct(const hduVector3D& v) const {
    hduVector3D product;
    hduVecCrossProduct(product.values_, values_, v.values_);
    return product;
  }
  /** Normalizes the vector to length 1; a zero vector is unchanged. */
  void normalize() { hduVecNormalizeInPlace(values_); }
  bool isZero(T tolerance) const { return magnitude() <= tolerance; }

 private:
  T values_[3];
};

template <class T>
inline T dotProduct(const hduVector3D<T>& a, const hduVector3D<T>& b) {
  return a.dotProduct(b);
}
template <class T>
inline hduVector3D<T> crossProduct(const hduVector3D<T>& a, const hduVector3D<T>& b) {
  return a.crossProduct(b);
}
template <class T>
inline hduVector3D<T> normalize(hduVector3D<T> v) {
  v.normalize();
  return v;
}

typedef hduVector3D<double> hduVector3Dd;
typedef hduVector3D<float> hduVector3Df;

#endif
