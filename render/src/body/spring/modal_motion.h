#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "body/spring/oscillator.h"
#include "body/spring/spring_network.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::render {

/// Moves a small spring network exactly, as the sum of its modes: each mode is an oscillator of its
/// own, stepped by its closed form. Stable and exact at any stiffness, mass and step, for forces
/// that are held over a step. A step costs some ns per mode; a push or a look at one node costs as
/// much again.
template <int kDof>
class THIMBLE_EXPORT ModalMotion {
 public:
  using Vector = typename SpringNetwork<kDof>::Vector;  ///< Numbers of a node.

  /// The most modes (nodes times directions) that are worked out: about 3 s and 20 MB.
  static constexpr std::int32_t kModesMax = 1600;

  /// Finds the modes for steps of `step` s (> 0). The error says that the network is too large, or
  /// that its dampers join its modes: dampers must be a share of the springs or of the masses, or
  /// be alike at all nodes and all edges that are alike. O(modes^3). Real-time: never from the
  /// servo thread.
  static driver::Result<ModalMotion> build(const SpringNetwork<kDof>& network, double step);

  // All of the following are Real-time: safe. Precondition: numbers name nodes that exist.

  /// Returns the frequency of a mode, rad/s; modes go from slow to fast.
  double omega(std::int32_t mode) const noexcept { return omega_[static_cast<std::size_t>(mode)]; }

  /// Adds displacement `u` (m) and velocity `v` (m/s) at a node, relative to its base point.
  void add(std::int32_t node, const Vector& u, const Vector& v) noexcept;
  /// Pushes a node by `f` (N) during the next step. Forces add up; NaN or beyond 10^6 N is none.
  void push(std::int32_t node, const Vector& f) noexcept;
  /// Moves on by one step under the forces pushed, which are then gone.
  void step() noexcept;
  /// Returns where a node is (m) and how it moves (m/s), relative to its base point.
  Vector u(std::int32_t node) const noexcept { return sum(node, x_); }
  /// Returns how a node moves, relative to its base point, m/s. Real-time: safe.
  Vector v(std::int32_t node) const noexcept { return sum(node, xdot_); }
  /// Returns the energy of all modes, J.
  double energy() const noexcept;

 private:
  ModalMotion() = default;
  Vector sum(std::int32_t node, const std::vector<double>& of) const noexcept;

  std::vector<double> shapes_;     // row per node and direction, over root of mass
  std::vector<double> root_mass_;  // per node, root of kg
  std::vector<double> omega_;
  std::vector<OscillatorStep> oscillators_;
  std::vector<double> x_, xdot_, f_;
};

extern template class ModalMotion<1>;
extern template class ModalMotion<3>;

}  // namespace thimble::render
