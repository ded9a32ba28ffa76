#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "body/spring/oscillator.h"
#include "body/spring/spring_network.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/spring_scheme.h"

namespace thimble::render {

/// Sets how a network is stepped.
struct SpringMotionOptions {
  /// What is done where the step is beyond what the scheme can bear.
  enum class Beyond {
    kSubstep,  ///< Take more, shorter steps per tick.
    kRefuse,   ///< Refuse to build.
    kAllow,    ///< Go on regardless: for tests and studies, which show what happens.
  };
  SpringScheme scheme = kDefaultScheme;  ///< How it is stepped.
  double step = 1e-3;                    ///< s per call of step(), > 0
  Beyond beyond = Beyond::kSubstep;      ///< What beyond its bound.
  int substeps = 1;                      ///< At least so many per call.
  int substeps_max = 64;                 ///< At most so many; a network that needs more is refused.
  int rounds_max = 25;                   ///< Of conjugate gradients per substep (implicit schemes).
  /// Remainder at which these rounds end early, as a share of what a step has to change.
  double remainder = 1e-6;
};

/// Moves a spring network in time by one scheme, some or all of its nodes.
///
/// Implicit Euler and the trapezoid rule never gain energy, at any stiffness, mass, step and number
/// of rounds. Both solve A w = b for the velocity w of the step; the rounds give some w, which is
/// then scaled to make w.(A w - b) = 0. With that alone, energy H and applied force f obey
///
///   implicit Euler  H+ - H = f.du - 1/2 |w - v|^2_M - h w.Cw - h^2/2 w.Kw  <= f.du
///   trapezoid       H+ - H = f.du - h w.Cw                                <= f.du
///
/// (insert A = M + hC + h^2 K, b = Mv + h(f - Ku), or the same with h/2, into the difference).
template <int kDof>
class THIMBLE_EXPORT SpringMotion {
 public:
  using Vector = typename SpringNetwork<kDof>::Vector;  ///< Numbers of a node.

  /// Makes a network ready to move, at rest. The error says which limit the step
  /// breaks and what would help. Real-time: never from the servo thread.
  static driver::Result<SpringMotion> build(SpringNetwork<kDof> network,
                                            const SpringMotionOptions& options = {});

  // All of the following are Real-time: safe. Precondition: numbers name nodes that exist.

  const SpringNetwork<kDof>& network() const noexcept { return network_; }  ///< Shows the network.
  int substeps() const noexcept { return substeps_; }  ///< Returns the steps of a tick.
  /// Returns how the step stands to the limit, in a sentence for a log. Real-time: never.
  std::string describe() const;

  /// Returns displacement (m) and velocity (m/s) of each node, relative to its base point.
  std::span<const Vector> u() const noexcept { return u_; }
  std::span<const Vector> v() const noexcept { return v_; }  ///< Returns velocities, m/s.
  /// Puts a node at displacement `u` with velocity `v`.
  void place(std::int32_t node, const Vector& u, const Vector& v) noexcept;

  /// Pushes a node by `f` (N) during the next step. Forces add up. What is NaN or beyond 10^6 N is
  /// no force and is left out.
  void push(std::int32_t node, const Vector& f) noexcept;

  /// Moves on by one step under the forces pushed, which are then gone.
  void step() noexcept;

  /// Returns the energy of springs and masses, J.
  double energy() const noexcept { return network_.energy(u_, v_); }

 private:
  explicit SpringMotion(SpringNetwork<kDof> network) : network_(std::move(network)) {}
  void prepare();
  void explicit_euler() noexcept;
  void symplectic_euler() noexcept;
  void verlet() noexcept;
  void implicit(double share) noexcept;
  void exponential() noexcept;
  void solve() noexcept;

  SpringNetwork<kDof> network_;
  SpringMotionOptions options_;
  double h_ = 0;  // s per substep
  int substeps_ = 1;
  std::int32_t count_ = 0;  // nodes
  std::vector<Vector> u_, v_, f_;
  std::vector<Vector> b_, w_, r_, p_, q_;  // what a step needs
  // Of the implicit schemes: A, and the diagonal it is preconditioned by.
  NetworkWeights system_;
  std::vector<double> inverse_diagonal_;
  std::vector<OscillatorStep> oscillators_;
};

extern template class SpringMotion<1>;
extern template class SpringMotion<3>;

}  // namespace thimble::render
