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

/// Options of stepping a network.
struct SpringMotionOptions {
  /// Action if the step exceeds the limit of the scheme.
  enum class Beyond {
    kSubstep,  ///< Take more, shorter steps per tick.
    kRefuse,   ///< Refuse to build.
    kAllow,    ///< Continue regardless: for tests and studies of the failure.
  };
  SpringScheme scheme = kDefaultScheme;  ///< Integration scheme.
  double step = 1e-3;                    ///< s per call of step(), > 0
  Beyond beyond = Beyond::kSubstep;      ///< Action beyond the scheme's limit.
  int substeps = 1;                      ///< Minimum number of substeps per call.
  int substeps_max = 64;                 ///< Maximum number of substeps per call; a network that
                                         ///< needs more is refused.
  int rounds_max = 25;                   ///< Most rounds of conjugate gradients per substep
                                         ///< (implicit schemes).
  /// Residual at which the rounds end early, as a share of the change of a step.
  double remainder = 1e-6;
};

/// Moves a spring network in time by one scheme.
///
/// Implicit Euler and the trapezoid rule never gain energy, at any stiffness, mass, step and number
/// of rounds. Both solve A w = b for the velocity w of the step. The rounds give some w, which is
/// then scaled to make w.(A w - b) = 0. This condition is sufficient: energy H and applied force f
/// obey
///
///   implicit Euler  H+ - H = f.du - 1/2 |w - v|^2_M - h w.Cw - h^2/2 w.Kw  <= f.du
///   trapezoid       H+ - H = f.du - h w.Cw                                <= f.du
///
/// (insert A = M + hC + h^2 K, b = Mv + h(f - Ku), or the same with h/2, into the difference).
template <int kDof>
class THIMBLE_EXPORT SpringMotion {
 public:
  using Vector = typename SpringNetwork<kDof>::Vector;  ///< Displacement of a node.

  /// Prepares a network for motion, at rest. The error names the limit that the step exceeds and
  /// the remedy. Real-time: never from the servo thread.
  static driver::Result<SpringMotion> build(SpringNetwork<kDof> network,
                                            const SpringMotionOptions& options = {});

  // All of the following are Real-time: safe. Precondition: numbers name existing nodes.

  const SpringNetwork<kDof>& network() const noexcept {
    return network_;
  }                                                    ///< Returns the network.
  int substeps() const noexcept { return substeps_; }  ///< Returns the number of steps per tick.
  /// Returns a sentence for a log about the step relative to its limit. Real-time: never.
  std::string describe() const;

  /// Returns the displacement of each node from its base point, m.
  std::span<const Vector> u() const noexcept { return u_; }
  std::span<const Vector> v() const noexcept {
    return v_;
  }  ///< Returns the velocity of each node
     ///< relative to its base point, m/s.
  /// Puts a node at displacement `u` with velocity `v`.
  void place(std::int32_t node, const Vector& u, const Vector& v) noexcept;

  /// Pushes a node by `f` (N) during the next step. Forces add up. A force that is NaN or beyond
  /// 10^6 N is ignored.
  void push(std::int32_t node, const Vector& f) noexcept;

  /// Advances by one step under the pushes, which are then cleared.
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
  std::vector<Vector> b_, w_, r_, p_, q_;  // work memory of a step
  // For the implicit schemes: A, and the diagonal of its preconditioner.
  NetworkWeights system_;
  std::vector<double> inverse_diagonal_;
  std::vector<OscillatorStep> oscillators_;
};

extern template class SpringMotion<1>;
extern template class SpringMotion<3>;

}  // namespace thimble::render
