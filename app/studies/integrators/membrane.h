#pragma once

#include <cstdint>
#include <vector>

#include "body/spring/spring_network.h"

namespace thimble::studies {

/// A square membrane of n x n nodes in a fixed frame that is pushed at one node and released: a
/// deformable body with exactly known motion [PHYSICS 4].
struct Membrane {
  std::int32_t n = 32;
  double mass = 1e-3;      ///< kg per node
  double stiffness = 300;  ///< N/m between neighbours, and from the outer nodes to the frame
  double damping = 0.02;   ///< N s/m per node
  double force = 1;        ///< N, constant from 0 until `poke`
  double poke = 0.05;      ///< s

  /// Returns the pushed node: not in the middle, so that symmetry excludes no mode.
  std::int32_t poked() const { return (2 * n / 5) * n + n / 3; }
};

/// Builds the membrane as a spring network with heights above the frame's plane. Real-time: never
/// from the servo thread.
render::SpringNetwork<1> membrane_network(const Membrane& membrane);

/// Returns the true height (m) of every node at time `t` (s): the sum of all n^2 sine modes, each
/// by its closed form. Real-time: never from the servo thread.
std::vector<double> membrane_truth(const Membrane& membrane, double t);

}  // namespace thimble::studies
