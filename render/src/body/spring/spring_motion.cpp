#include "body/spring/spring_motion.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace thimble::render {
namespace {

// Steps this near to the limit count as beyond it: at the limit itself energy grows by rounding.
constexpr double kShareOfLimit = 0.98;

// No arm pushes harder; the bound keeps squares far from overflow.
constexpr double kForceMax = 1e6;

// Rounding of a sum over a node and its springs, as a share of it.
constexpr double kRoundingOfSum = 1e-15;

std::size_t at(std::int32_t node) {
  return static_cast<std::size_t>(node);
}

}  // namespace

template <int kDof>
driver::Result<SpringMotion<kDof>> SpringMotion<kDof>::build(SpringNetwork<kDof> network,
                                                             const SpringMotionOptions& options) {
  using Beyond = SpringMotionOptions::Beyond;
  const std::string name(name_of(options.scheme));
  if (!(options.step > 0) || !std::isfinite(options.step)) {
    return driver::Error{"A body needs a time step above 0 s."};
  }
  if (options.substeps < 1 || options.rounds_max < 1 || options.substeps_max < options.substeps) {
    return driver::Error{"A body needs at least one substep and one round."};
  }
  if (options.scheme == SpringScheme::kModal) {
    return driver::Error{"Use the class ModalMotion for modal motion."};
  }
  if (options.scheme == SpringScheme::kExponential && network.coupled()) {
    return driver::Error{
        "The exponential integrator works only for nodes that no springs join. Use modal for a "
        "small "
        "mesh, implicit_euler for any mesh."};
  }
  SpringMotion motion(std::move(network));
  motion.options_ = options;
  const double limit = kShareOfLimit * largest_step(options.scheme, motion.network_.bounds());
  const double needed = std::ceil(options.step / limit);
  motion.substeps_ = options.substeps;
  if (needed > options.substeps && options.beyond != Beyond::kAllow) {
    if (options.beyond == Beyond::kRefuse || !(needed <= options.substeps_max)) {
      return driver::Error{
          limit > 0
              ? fmt::format("Integrator {} is stable for steps up to {:.3g} ms on this mesh, but "
                            "the tick takes {:.3g} ms. Lower the stiffness, add mass, use "
                            "{:.0f} substeps, or use implicit_euler.",
                            name, limit * 1e3, options.step * 1e3, needed)
              : "Integrator " + name +
                    " is unstable at any step on springs without dampers. Use implicit_euler."};
    }
    motion.substeps_ = static_cast<int>(needed);
  }
  motion.prepare();
  return motion;
}

template <int kDof>
void SpringMotion<kDof>::prepare() {
  const std::size_t n = at(network_.node_count());
  h_ = options_.step / substeps_;
  count_ = network_.node_count();
  for (auto* each : {&u_, &v_, &f_, &q_, &b_, &w_, &p_}) each->assign(n, Vector::Zero());
  if (options_.scheme == SpringScheme::kExponential) {
    for (std::int32_t i = 0; i < count_; ++i) {
      oscillators_.push_back(OscillatorStep::of(network_.mass(i), network_.stiffness().node[at(i)],
                                                network_.damping().node[at(i)], h_));
    }
  }
  const bool euler = options_.scheme == SpringScheme::kImplicitEuler;
  if (!euler && options_.scheme != SpringScheme::kTrapezoid) return;
  r_.assign(n, Vector::Zero());
  const double share = euler ? h_ : h_ / 2;
  const NetworkWeights& k = network_.stiffness();
  const NetworkWeights& c = network_.damping();
  for (std::size_t e = 0; e < k.half.size(); ++e) {
    system_.half.push_back(share * c.half[e] + share * share * k.half[e]);
  }
  std::size_t e = 0;
  for (std::int32_t i = 0; i < count_; ++i) {
    double diagonal = network_.mass(i) + share * c.node[at(i)] + share * share * k.node[at(i)];
    system_.node.push_back(diagonal);
    for (std::size_t s = 0; s < network_.neighbours(i).size(); ++s) diagonal += system_.half[e++];
    inverse_diagonal_.push_back(1 / diagonal);
  }
}

template <int kDof>
std::string SpringMotion<kDof>::describe() const {
  const std::string name(name_of(options_.scheme));
  const double limit = largest_step(options_.scheme, network_.bounds());
  std::string text =
      std::isfinite(limit)
          ? fmt::format("{} is stable for steps up to {:.3g} ms on this mesh", name, limit * 1e3)
          : name + " is stable for any step";
  text += fmt::format(" (highest frequency {:.4g} rad/s). Steps per tick: {} of {:.3g} ms.",
                      network_.bounds().omega_max, substeps_, h_ * 1e3);
  return text;
}

template <int kDof>
void SpringMotion<kDof>::place(std::int32_t node, const Vector& u, const Vector& v) noexcept {
  u_[at(node)] = u;
  v_[at(node)] = v;
}

template <int kDof>
void SpringMotion<kDof>::push(std::int32_t node, const Vector& f) noexcept {
  // Written so that NaN means no force.
  if (f.squaredNorm() <= kForceMax * kForceMax) f_[at(node)] += f;
}

template <int kDof>
void SpringMotion<kDof>::step() noexcept {
  for (int i = 0; i < substeps_; ++i) {
    switch (options_.scheme) {
      case SpringScheme::kExplicitEuler:
        explicit_euler();
        break;
      case SpringScheme::kSymplecticEuler:
        symplectic_euler();
        break;
      case SpringScheme::kVerlet:
        verlet();
        break;
      case SpringScheme::kImplicitEuler:
        implicit(1);
        break;
      case SpringScheme::kTrapezoid:
        implicit(0.5);
        break;
      case SpringScheme::kExponential:
        exponential();
        break;
      case SpringScheme::kModal:
        break;  // build() refuses it
    }
  }
  for (std::int32_t i = 0; i < count_; ++i) f_[at(i)].setZero();
}

template <int kDof>
void SpringMotion<kDof>::explicit_euler() noexcept {
  for (std::int32_t i = 0; i < count_; ++i) {
    Vector force = f_[at(i)] - network_.row(network_.stiffness(), i, u_);
    if (network_.damped()) force -= network_.row(network_.damping(), i, v_);
    q_[at(i)] = force / network_.mass(i);
  }
  for (std::int32_t i = 0; i < count_; ++i) {
    u_[at(i)] += h_ * v_[at(i)];
    v_[at(i)] += h_ * q_[at(i)];
  }
}

template <int kDof>
void SpringMotion<kDof>::symplectic_euler() noexcept {
  for (std::int32_t i = 0; i < count_; ++i) {
    Vector force = f_[at(i)] - network_.row(network_.stiffness(), i, u_);
    if (network_.damped()) force -= network_.row(network_.damping(), i, v_);
    q_[at(i)] = force / network_.mass(i);
  }
  for (std::int32_t i = 0; i < count_; ++i) {
    v_[at(i)] += h_ * q_[at(i)];
    u_[at(i)] += h_ * v_[at(i)];
  }
}

// Half a drift, one kick, half a drift. During the kick dampers act by the midpoint rule, so that
// the scheme stays of order 2 with one evaluation of the springs.
template <int kDof>
void SpringMotion<kDof>::verlet() noexcept {
  for (std::int32_t i = 0; i < count_; ++i) u_[at(i)] += h_ / 2 * v_[at(i)];
  for (std::int32_t i = 0; i < count_; ++i) {
    b_[at(i)] = f_[at(i)] - network_.row(network_.stiffness(), i, u_);
  }
  if (network_.damped()) {
    for (std::int32_t i = 0; i < count_; ++i) {
      const Vector force = b_[at(i)] - network_.row(network_.damping(), i, v_);
      q_[at(i)] = v_[at(i)] + h_ / 2 / network_.mass(i) * force;
    }
    for (std::int32_t i = 0; i < count_; ++i) b_[at(i)] -= network_.row(network_.damping(), i, q_);
  }
  for (std::int32_t i = 0; i < count_; ++i) {
    v_[at(i)] += h_ / network_.mass(i) * b_[at(i)];
    u_[at(i)] += h_ / 2 * v_[at(i)];
  }
}

// One substep of implicit Euler (share 1) or of the trapezoid rule (share 1/2).
template <int kDof>
void SpringMotion<kDof>::implicit(double share) noexcept {
  const double h = share * h_;
  for (std::int32_t i = 0; i < count_; ++i) {
    b_[at(i)] =
        network_.mass(i) * v_[at(i)] + h * (f_[at(i)] - network_.row(network_.stiffness(), i, u_));
  }
  solve();
  const bool euler = share == 1;
  for (std::int32_t i = 0; i < count_; ++i) {
    u_[at(i)] += h_ * w_[at(i)];
    if (euler) {
      v_[at(i)] = w_[at(i)];
    } else {
      v_[at(i)] = 2 * w_[at(i)] - v_[at(i)];
    }
  }
}

// Solves A w = b by conjugate gradients from v on, and scales w as required by the proof in the
// header.
template <int kDof>
void SpringMotion<kDof>::solve() noexcept {
  double start = 0;  // b.D^-1 b, for the bound by rounding
  double rz = 0;
  for (std::int32_t i = 0; i < count_; ++i) {
    w_[at(i)] = v_[at(i)];
    p_[at(i)].setZero();
  }
  for (std::int32_t i = 0; i < count_; ++i) {
    const double d = inverse_diagonal_[at(i)];
    r_[at(i)] = b_[at(i)] - network_.row(system_, i, w_);
    start += d * b_[at(i)].squaredNorm();
    rz += d * r_[at(i)].squaredNorm();
  }
  // Relative to the change due to springs and dampers: in a slow motion they change little of the
  // momentum in a step.
  const double end = std::max(options_.remainder * options_.remainder * rz,
                              kRoundingOfSum * kRoundingOfSum * start);
  double beta = 0;
  for (int round = 0; round < options_.rounds_max && rz > end; ++round) {
    for (std::int32_t i = 0; i < count_; ++i) {
      p_[at(i)] = inverse_diagonal_[at(i)] * r_[at(i)] + beta * p_[at(i)];
    }
    double pq = 0;
    for (std::int32_t i = 0; i < count_; ++i) {
      q_[at(i)] = network_.row(system_, i, p_);
      pq += p_[at(i)].dot(q_[at(i)]);
    }
    if (!(pq > 0)) break;
    const double alpha = rz / pq;
    double rz_next = 0;
    for (std::int32_t i = 0; i < count_; ++i) {
      w_[at(i)] += alpha * p_[at(i)];
      r_[at(i)] -= alpha * q_[at(i)];
      rz_next += inverse_diagonal_[at(i)] * r_[at(i)].squaredNorm();
    }
    beta = rz_next / rz;
    rz = rz_next;
  }
  double wb = 0;
  double waw = 0;
  for (std::int32_t i = 0; i < count_; ++i) {
    wb += w_[at(i)].dot(b_[at(i)]);
    waw += w_[at(i)].dot(network_.row(system_, i, w_));
  }
  const double scale = waw > 0 ? wb / waw : 0;
  for (std::int32_t i = 0; i < count_; ++i) w_[at(i)] *= scale;
}

template <int kDof>
void SpringMotion<kDof>::exponential() noexcept {
  for (std::int32_t i = 0; i < count_; ++i) {
    oscillators_[at(i)].apply(u_[at(i)], v_[at(i)], f_[at(i)]);
  }
}

template class SpringMotion<1>;
template class SpringMotion<3>;

}  // namespace thimble::render
