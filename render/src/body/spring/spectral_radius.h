#pragma once

#include <span>

#include "body/spring/spring_network.h"

namespace thimble::render {

/// The largest eigenvalue of M^-1 A.
struct SpectralRadius {
  double value = 0;       ///< Including its residual; never above `gershgorin`.
  double gershgorin = 0;  ///< Bound from row sums.
  bool converged = true;
};

/// Computes the largest eigenvalue of M^-1 A for A of the network's pattern by Lanczos' iteration.
/// This is the power iteration, with the best vector of all its rounds instead of the last.
/// Real-time: never from the servo thread.
template <int kDof>
SpectralRadius spectral_radius(const SpringNetwork<kDof>& network, const NetworkWeights& weights);

}  // namespace thimble::render
