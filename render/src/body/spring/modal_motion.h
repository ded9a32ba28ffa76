#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "body/spring/oscillator.h"
#include "body/spring/spring_network.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::render {

/// Moves a small spring network exactly, as the sum of its modes: each mode is an independent
/// oscillator, stepped by its closed form. Stable and exact at any stiffness, mass and step, for
/// forces that are held over a step. A step costs some ns per mode; pushing or reading one node
/// costs the same again.
template <int kDof>
class THIMBLE_EXPORT ModalMotion {
 public:
  using Vector = typename SpringNetwork<kDof>::Vector;  ///< Displacement of a node.

  /// Maximum number of modes (nodes times directions): about 3 s and 20 MB.
  static constexpr std::int32_t kModesMax = 1600;

  /// Computes the modes for steps of `step` s (> 0). The error states that the network is too
  /// large, or that its dampers couple its modes. Dampers must be proportional to the springs or to
  /// the masses, or be equal at all nodes and all edges that are equal. O(modes^3). Real-time:
  /// never from the servo thread.
  static driver::Result<ModalMotion> build(const SpringNetwork<kDof>& network, double step);

  // All of the following are Real-time: safe. Precondition: numbers name existing nodes.

  /// Returns the frequency of a mode, rad/s; modes are in ascending order.
  double omega(std::int32_t mode) const noexcept { return omega_[static_cast<std::size_t>(mode)]; }

  /// Adds displacement `u` (m) and velocity `v` (m/s) at a node, relative to its base point.
  void add(std::int32_t node, const Vector& u, const Vector& v) noexcept;
  /// Pushes a node by `f` (N) during the next step. Forces add up; NaN or beyond 10^6 N is ignored.
  void push(std::int32_t node, const Vector& f) noexcept;
  /// Advances by one step under the pushes, which are then cleared.
  void step() noexcept;
  /// Returns the displacement of a node from its base point, m.
  Vector u(std::int32_t node) const noexcept { return sum(node, x_); }
  /// Returns the velocity of a node relative to its base point, m/s. Real-time: safe.
  Vector v(std::int32_t node) const noexcept { return sum(node, xdot_); }
  /// Returns the energy of all modes, J.
  double energy() const noexcept;

 private:
  ModalMotion() = default;
  Vector sum(std::int32_t node, const std::vector<double>& of) const noexcept;

  std::vector<double> shapes_;     // row per node and direction, divided by the root of the mass
  std::vector<double> root_mass_;  // per node, root of kg
  std::vector<double> omega_;
  std::vector<OscillatorStep> oscillators_;
  std::vector<double> x_, xdot_, f_;
};

extern template class ModalMotion<1>;
extern template class ModalMotion<3>;

}  // namespace thimble::render
