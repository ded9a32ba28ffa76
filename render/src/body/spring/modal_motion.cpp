#include "body/spring/modal_motion.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

namespace thimble::render {
namespace {

using Eigen::MatrixXd;

// Maximum coupling of two modes by the dampers, relative to their largest rate: some rounding of
// the eigenvectors, and far below what a hand can distinguish.
constexpr double kJoined = 1e-8;
constexpr double kForceMax = 1e6;  // N; no arm pushes harder

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

// Returns M^-1/2 A M^-1/2 as a dense matrix.
template <int kDof>
MatrixXd dense(const SpringNetwork<kDof>& network, const NetworkWeights& weights) {
  using Vector = typename SpringNetwork<kDof>::Vector;
  const std::int32_t n = network.node_count();
  MatrixXd matrix = MatrixXd::Zero(Eigen::Index{n} * kDof, Eigen::Index{n} * kDof);
  std::vector<Vector> unit(at(n), Vector::Zero());
  for (std::int32_t i = 0; i < n; ++i) {
    for (int k = 0; k < kDof; ++k) {
      unit[at(i)][k] = 1;
      const auto put = [&](std::int32_t j) {
        matrix.template block<kDof, 1>(j * kDof, i * kDof + k) =
            network.row(weights, j, unit) / std::sqrt(network.mass(i) * network.mass(j));
      };
      put(i);
      for (const std::int32_t j : network.neighbours(i)) put(j);
      unit[at(i)].setZero();
    }
  }
  return matrix;
}

}  // namespace

template <int kDof>
driver::Result<ModalMotion<kDof>> ModalMotion<kDof>::build(const SpringNetwork<kDof>& network,
                                                           double step) {
  const std::int32_t nodes = network.node_count();
  if (nodes > kModesMax / kDof) {
    return driver::Error{"Modal motion supports bodies of up to " +
                         std::to_string(kModesMax / kDof) + " vertices; this one has " +
                         std::to_string(nodes) + ". Use implicit_euler or a coarser mesh."};
  }
  if (!(step > 0) || !std::isfinite(step)) {
    return driver::Error{"A body needs a time step above 0 s."};
  }
  const MatrixXd k = dense(network, network.stiffness());
  MatrixXd shapes;
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(k.rows());
  if (!network.damped()) {
    shapes = Eigen::SelfAdjointEigenSolver<MatrixXd>(k).eigenvectors();
  } else {
    const MatrixXd c = dense(network, network.damping());
    // Matrices that commute have common eigenvectors, and these are the eigenvectors of nearly
    // every sum of the two. Where the springs leave a choice, the dampers decide.
    const double share = k.norm() > 0 ? k.norm() / c.norm() / std::numbers::phi : 1;
    shapes = Eigen::SelfAdjointEigenSolver<MatrixXd>(k + share * c).eigenvectors();
    const MatrixXd by_mode = shapes.transpose() * c * shapes;
    rates = by_mode.diagonal();
    const MatrixXd joined = by_mode - MatrixXd(rates.asDiagonal());
    // Written so that NaN is refused.
    if (!(joined.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <=
          kJoined * rates.cwiseAbs().maxCoeff<Eigen::PropagateNaN>())) {
      return driver::Error{
          "The dampers of this body couple its modes, so modal motion would not be exact. Give "
          "each "
          "damper the same ratio to its spring, or use implicit_euler."};
    }
  }
  Eigen::VectorXd squares = (shapes.transpose() * k * shapes).diagonal();
  std::vector<Eigen::Index> order(static_cast<std::size_t>(squares.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Eigen::Index a, Eigen::Index b) { return squares[a] < squares[b]; });
  ModalMotion motion;
  for (const Eigen::Index m : order) {
    const double square = std::max(squares[m], 0.0);
    motion.omega_.push_back(std::sqrt(square));
    motion.oscillators_.push_back(OscillatorStep::of(1, square, std::max(rates[m], 0.0), step));
  }
  for (std::int32_t i = 0; i < nodes; ++i) {
    motion.root_mass_.push_back(std::sqrt(network.mass(i)));
    for (int d = 0; d < kDof; ++d) {
      for (const Eigen::Index m : order) {
        motion.shapes_.push_back(shapes(i * kDof + d, m) / motion.root_mass_.back());
      }
    }
  }
  for (auto* each : {&motion.x_, &motion.xdot_, &motion.f_}) each->assign(order.size(), 0.0);
  return motion;
}

template <int kDof>
void ModalMotion<kDof>::add(std::int32_t node, const Vector& u, const Vector& v) noexcept {
  const double mass = root_mass_[at(node)] * root_mass_[at(node)];
  for (int d = 0; d < kDof; ++d) {
    const double* shape = shapes_.data() + (at(node) * kDof + at(d)) * x_.size();
    for (std::size_t m = 0; m < x_.size(); ++m) {
      x_[m] += shape[m] * mass * u[d];
      xdot_[m] += shape[m] * mass * v[d];
    }
  }
}

template <int kDof>
void ModalMotion<kDof>::push(std::int32_t node, const Vector& f) noexcept {
  // Written so that NaN means no force.
  if (!(f.squaredNorm() <= kForceMax * kForceMax)) return;
  for (int d = 0; d < kDof; ++d) {
    const double* shape = shapes_.data() + (at(node) * kDof + at(d)) * x_.size();
    for (std::size_t m = 0; m < x_.size(); ++m) f_[m] += shape[m] * f[d];
  }
}

template <int kDof>
void ModalMotion<kDof>::step() noexcept {
  for (std::size_t m = 0; m < x_.size(); ++m) {
    oscillators_[m].apply(x_[m], xdot_[m], f_[m]);
    f_[m] = 0;
  }
}

template <int kDof>
typename ModalMotion<kDof>::Vector ModalMotion<kDof>::sum(
    std::int32_t node, const std::vector<double>& of) const noexcept {
  Vector total;
  for (int d = 0; d < kDof; ++d) {
    const double* shape = shapes_.data() + (at(node) * kDof + at(d)) * x_.size();
    double value = 0;
    for (std::size_t m = 0; m < x_.size(); ++m) value += shape[m] * of[m];
    total[d] = value;
  }
  return total;
}

template <int kDof>
double ModalMotion<kDof>::energy() const noexcept {
  double twice = 0;
  for (std::size_t m = 0; m < x_.size(); ++m) {
    twice += xdot_[m] * xdot_[m] + omega_[m] * omega_[m] * x_[m] * x_[m];
  }
  return twice / 2;
}

template class ModalMotion<1>;
template class ModalMotion<3>;

}  // namespace thimble::render
