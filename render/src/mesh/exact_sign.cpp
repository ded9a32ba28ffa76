#include "mesh/exact_sign.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Bound on the rounding error of the triple product of differences, relative to the sum of its
// terms' magnitudes: (7 + 56 e) e with e = 2^-53 [Shewchuk, section 4.3].
constexpr double kOrientationError = 7.7715611723761027e-16;

// A sum of doubles without rounding: components that do not overlap, the largest last.
class ExactSum {
 public:
  void add(double value) noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = value + parts_[i];
      const double part = sum - value;
      const double error = (value - (sum - part)) + (parts_[i] - part);
      if (error != 0) parts_[kept++] = error;
      value = sum;
    }
    if (value != 0) parts_[kept++] = value;
    size_ = kept;
  }

  void add_product(double x, double y) noexcept {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  }

  void add_product(double x, double y, double z) noexcept {
    const double product = x * y;
    add_product(std::fma(x, y, -product), z);
    add_product(product, z);
  }

  // Adds sign * det(a, b, c).
  void add_determinant(double sign, const Vector3d& a, const Vector3d& b,
                       const Vector3d& c) noexcept {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      add_product(sign * a[i], b[j], c[k]);
      add_product(-sign * a[i], b[k], c[j]);
    }
  }

  int sign() const noexcept {
    if (size_ == 0) return 0;
    return parts_[size_ - 1] > 0 ? 1 : -1;
  }

 private:
  // Four determinants of six products of three factors, four doubles each.
  std::array<double, 96> parts_;
  std::size_t size_ = 0;
};

}  // namespace

int orientation(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                const Vector3d& d) noexcept {
  const Vector3d u = b - a;
  const Vector3d v = c - a;
  const Vector3d w = d - a;
  double sum = 0;
  double magnitude = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const double left = u[j] * v[k];
    const double right = u[k] * v[j];
    sum += w[i] * (left - right);
    magnitude += std::abs(w[i]) * (std::abs(left) + std::abs(right));
  }
  const double error = kOrientationError * magnitude;
  if (sum > error) return 1;
  if (sum < -error) return -1;

  ExactSum exact;
  exact.add_determinant(1, b, c, d);
  exact.add_determinant(-1, a, c, d);
  exact.add_determinant(1, a, b, d);
  exact.add_determinant(-1, a, b, c);
  return exact.sign();
}

int cross_sign(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d,
               int axis) noexcept {
  const int j = (axis + 1) % 3;
  const int k = (axis + 2) % 3;
  ExactSum exact;
  for (const auto& [first, second, sign] : {std::tuple{j, k, 1.0}, std::tuple{k, j, -1.0}}) {
    exact.add_product(sign * b[first], d[second]);
    exact.add_product(-sign * b[first], c[second]);
    exact.add_product(-sign * a[first], d[second]);
    exact.add_product(sign * a[first], c[second]);
  }
  return exact.sign();
}

}  // namespace thimble::render
