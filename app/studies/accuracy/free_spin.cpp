#include "studies/accuracy/free_spin.h"

#include <array>
#include <cmath>

namespace thimble::studies {
namespace {

struct Jacobi {
  double sn, cn, dn;
};

// Returns Jacobi's functions of parameter m = k^2 < 1 by the arithmetic-geometric mean [S
// Abramowitz and Stegun 16.4].
Jacobi jacobi(double u, double m) {
  std::array<double, 16> a{}, c{};
  a[0] = 1;
  c[0] = std::sqrt(m);
  double b = std::sqrt(1 - m);
  std::size_t n = 0;
  while (n + 1 < a.size() && std::abs(c[n]) > 1e-17) {
    a[n + 1] = (a[n] + b) / 2;
    c[n + 1] = (a[n] - b) / 2;
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phi = std::ldexp(a[n] * u, static_cast<int>(n));
  for (; n > 0; --n) phi = (phi + std::asin(c[n] / a[n] * std::sin(phi))) / 2;
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1 - m * sn * sn)};
}

// Returns u with sn(u) = s, cn(u) > 0, by Carlson's R_F(c^2, 1 - m s^2, 1) [S Abramowitz and Stegun
// 17; Carlson 1979].
double inverse_sn(double s, double m) {
  double x = 1 - s * s, y = 1 - m * s * s, z = 1;
  for (int i = 0; i < 40; ++i) {
    const double lambda = std::sqrt(x * y) + std::sqrt(y * z) + std::sqrt(z * x);
    x = (x + lambda) / 4;
    y = (y + lambda) / 4;
    z = (z + lambda) / 4;
  }
  return s / std::sqrt((x + y + z) / 3);
}

}  // namespace

Eigen::Vector3d true_rate(const FreeSpin& spin, double t) {
  const Eigen::Vector3d& I = spin.inertia;
  const Eigen::Vector3d& w = spin.omega;
  const double energy2 = I.dot(w.cwiseAbs2());
  const double momentum2 = I.cwiseProduct(w).squaredNorm();
  // If momentum^2 > 2 E I_2, axis 3 keeps its sign; otherwise axis 1 does, and the two are
  // exchanged.
  const bool swap = momentum2 < energy2 * I[1];
  const int one = swap ? 2 : 0;
  const int three = swap ? 0 : 2;
  const double i1 = I[one], i2 = I[1], i3 = I[three];
  const double amplitude1 = std::sqrt((energy2 * i3 - momentum2) / (i1 * (i3 - i1)));
  const double amplitude2 = std::sqrt((energy2 * i3 - momentum2) / (i2 * (i3 - i2)));
  const double amplitude3 = std::sqrt((momentum2 - energy2 * i1) / (i3 * (i3 - i1)));
  const double rate = std::sqrt((i3 - i2) * (momentum2 - energy2 * i1) / (i1 * i2 * i3));
  const double m =
      (i2 - i1) * (energy2 * i3 - momentum2) / ((i3 - i2) * (momentum2 - energy2 * i1));
  // Selects the branch: cn has the sign of w1 over that of its amplitude. The direction of axis 2
  // follows from Euler's equation I2 w2' = (I3 - I1) w3 w1.
  const double sign1 = w[one] >= 0 ? 1 : -1;
  const double sign3 = w[three] >= 0 ? 1 : -1;
  const double sense = sign1 * sign3;
  const double begin = inverse_sn(sense * w[1] / amplitude2, m);
  const Jacobi at = jacobi(begin + rate * t, m);
  Eigen::Vector3d omega;
  omega[one] = sign1 * amplitude1 * at.cn;
  omega[1] = sense * amplitude2 * at.sn;
  omega[three] = sign3 * amplitude3 * at.dn;
  return omega;
}

}  // namespace thimble::studies
