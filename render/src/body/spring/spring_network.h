#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/network_bounds.h"

namespace thimble::render {

/// One node: a mass on a spring and a damper to its own base point [BP Fig. 6, 7].
struct BodyNode {
  double mass = 1e-3;         ///< kg, > 0
  double base_stiffness = 0;  ///< N/m, >= 0
  double base_damping = 0;    ///< N s/m, >= 0
};

/// Joins two nodes by a spring and a damper, at rest while both have the same displacement.
template <int kDof>
struct BodySpring {
  std::int32_t a = 0;    ///< One node.
  std::int32_t b = 0;    ///< The other.
  double stiffness = 0;  ///< N/m, >= 0
  double damping = 0;    ///< N s/m, >= 0
  /// Unit vector: pulls only along it. Zero: pulls equally in all directions. All springs of a
  /// network must be of one kind.
  Eigen::Matrix<double, kDof, 1> along = Eigen::Matrix<double, kDof, 1>::Zero();
};

/// A matrix with the network's pattern: one weight per node and one per half of a spring.
struct NetworkWeights {
  std::vector<double> node;  ///< Weight of each node.
  std::vector<double> half;  ///< Half of each spring's weight.
  bool joined = true;        ///< False if all of `half` is 0, so that it need not be read.
};

/// Masses, springs and dampers between nodes: M u'' + C u' + K u = f, with u the displacements from
/// the base points. `kDof` = 3: vectors (m); 1: displacements along each vertex's normal (m).
///
/// Linear in u, and at rest at u = 0 wherever the base points are. So moving base points (rigid
/// motion, clay, snap) changes the shape without straining it. K and C are symmetric and never
/// negative; the proofs about the integrators use this (spring_motion.h).
template <int kDof>
class THIMBLE_EXPORT SpringNetwork {
 public:
  using Vector = Eigen::Matrix<double, kDof, 1>;  ///< Displacement of a node.

  /// Checks and joins nodes and springs, and computes the bounds. The error names the first node or
  /// spring with a mass that is not positive, a negative or infinite constant, an end that does not
  /// exist, or a direction that is neither unit nor zero. Real-time: never from the servo thread.
  static driver::Result<SpringNetwork> build(std::span<const BodyNode> nodes,
                                             std::span<const BodySpring<kDof>> springs);

  // All of the following are Real-time: safe. Precondition: numbers are valid, spans have one entry
  // per node.

  /// Returns the number of nodes. Real-time: safe.
  std::int32_t node_count() const noexcept { return static_cast<std::int32_t>(mass_.size()); }
  /// Returns the mass of a node, kg. Real-time: safe.
  double mass(std::int32_t node) const noexcept { return mass_[static_cast<std::size_t>(node)]; }
  const NetworkWeights& stiffness() const noexcept {
    return stiffness_;
  }  ///< Returns the stiffness matrix.
  const NetworkWeights& damping() const noexcept {
    return damping_;
  }  ///< Returns the damping matrix.
  /// Returns whether springs or dampers join nodes.
  bool coupled() const noexcept { return coupled_; }
  bool damped() const noexcept { return damped_; }  ///< Returns whether there are dampers.
  const NetworkBounds& bounds() const noexcept { return bounds_; }  ///< Returns the bounds.

  /// Lists the nodes joined to `node` by springs.
  std::span<const std::int32_t> neighbours(std::int32_t node) const noexcept {
    const auto i = static_cast<std::size_t>(node);
    return {other_.data() + begin_[i], begin_[i + 1] - begin_[i]};
  }

  /// Computes y_i = w_i x_i + sum over i's springs of w (x_i - x_other), for the given `nodes`.
  void multiply(const NetworkWeights& weights, std::span<const std::int32_t> nodes,
                std::span<const Vector> x, std::span<Vector> y) const noexcept;

  /// Returns only row `node` of that product.
  Vector row(const NetworkWeights& weights, std::int32_t node,
             std::span<const Vector> x) const noexcept;

  /// Returns the energy of displacements `u` (m) and velocities `v` (m/s), J.
  double energy(std::span<const Vector> u, std::span<const Vector> v) const noexcept;

 private:
  SpringNetwork() = default;

  std::vector<double> mass_;
  NetworkWeights stiffness_;
  NetworkWeights damping_;
  std::vector<std::size_t> begin_;
  std::vector<std::int32_t> other_;
  std::vector<Vector> along_;  // per half of a spring; empty if springs pull in all directions
  bool coupled_ = false;
  bool damped_ = false;
  NetworkBounds bounds_;
};

extern template class SpringNetwork<1>;
extern template class SpringNetwork<3>;

}  // namespace thimble::render
