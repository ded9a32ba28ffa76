#include "body/spring/spectral_radius.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace thimble::render {
namespace {

// Rounds until the residual is small. Membranes of 10^4 nodes need about 100, since their highest
// frequencies are close together.
constexpr int kRoundsMax = 400;
constexpr int kRoundsBetweenLooks = 20;
constexpr double kRemainder = 1e-8;

struct Ritz {
  double value = 0;
  double remainder = 0;
};

// Returns the largest eigenvalue of the tridiagonal matrix and its maximum error.
Ritz largest(const std::vector<double>& alpha, const std::vector<double>& beta) {
  const auto n = static_cast<Eigen::Index>(alpha.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(alpha.data(), n),
                                Eigen::Map<const Eigen::VectorXd>(beta.data(), n - 1));
  return {solver.eigenvalues()[n - 1], beta.back() * std::abs(solver.eigenvectors()(n - 1, n - 1))};
}

}  // namespace

template <int kDof>
SpectralRadius spectral_radius(const SpringNetwork<kDof>& network, const NetworkWeights& weights) {
  using Vector = typename SpringNetwork<kDof>::Vector;
  const auto n = static_cast<std::size_t>(network.node_count());
  std::vector<std::int32_t> nodes(n);
  std::iota(nodes.begin(), nodes.end(), 0);
  SpectralRadius found;
  std::size_t half = 0;
  for (const std::int32_t i : nodes) {
    double sum = weights.node[static_cast<std::size_t>(i)];
    for (std::size_t e = 0; e < network.neighbours(i).size(); ++e) sum += 2 * weights.half[half++];
    found.gershgorin = std::max(found.gershgorin, sum / network.mass(i));
  }
  if (!(found.gershgorin > 0)) return found;

  // On M^-1/2 A M^-1/2, which is symmetric and has the same eigenvalues; scaled to at most 1.
  std::vector<Vector> q(n), before(n, Vector::Zero()), scaled(n), product(n);
  std::mt19937_64 bits(20);  // any start that is not an eigenvector works; fixed, to be repeatable
  double norm = 0;
  for (Vector& x : q) {
    for (int k = 0; k < kDof; ++k) x[k] = static_cast<double>(bits() >> 11) * 0x1p-53 - 0.5;
    norm += x.squaredNorm();
  }
  for (Vector& x : q) x /= std::sqrt(norm);
  std::vector<double> alpha, beta;
  Ritz ritz;
  double last_beta = 0;
  const std::size_t rounds = std::min<std::size_t>(kRoundsMax, n * kDof);
  for (std::size_t round = 1; round <= rounds; ++round) {
    for (const std::int32_t i : nodes) {
      const auto k = static_cast<std::size_t>(i);
      scaled[k] = q[k] / std::sqrt(network.mass(i));
    }
    network.multiply(weights, nodes, scaled, product);
    double a = 0;
    for (const std::int32_t i : nodes) {
      const auto k = static_cast<std::size_t>(i);
      product[k] /= std::sqrt(network.mass(i)) * found.gershgorin;
      a += product[k].dot(q[k]);
    }
    double b = 0;
    for (std::size_t k = 0; k < n; ++k) {
      product[k] -= a * q[k] + last_beta * before[k];
      b += product[k].squaredNorm();
    }
    b = std::sqrt(b);
    alpha.push_back(a);
    beta.push_back(b);
    const bool exhausted = !(b > 1e-14);
    if (exhausted || round == rounds || round % kRoundsBetweenLooks == 0) {
      ritz = largest(alpha, beta);
      if (exhausted || ritz.remainder <= kRemainder * ritz.value) break;
    }
    for (std::size_t k = 0; k < n; ++k) {
      before[k] = q[k];
      q[k] = product[k] / b;
    }
    last_beta = b;
  }
  found.converged = ritz.remainder <= kRemainder * ritz.value || rounds < kRoundsMax;
  found.value = std::min(1.0, ritz.value + ritz.remainder) * found.gershgorin;
  return found;
}

template SpectralRadius spectral_radius<1>(const SpringNetwork<1>&, const NetworkWeights&);
template SpectralRadius spectral_radius<3>(const SpringNetwork<3>&, const NetworkWeights&);

}  // namespace thimble::render
