#pragma once

namespace thimble::render {

/// Bounds on the dynamics of a spring network, computed when it is built.
struct NetworkBounds {
  /// Highest natural frequency, rad/s: Lanczos iteration on masses and springs, to 1e-8 or as
  /// `converged` says. Its residual is added, so that the value is never too low.
  double omega_max = 0;
  /// Cheap upper bound of omega_max (Gershgorin: row sums), rad/s; sqrt(2 valence k / m) for
  /// springs only [PHYSICS 4].
  double omega_gershgorin = 0;
  /// Highest rate at which dampers stop a node, 1/s: the same bound for masses and dampers.
  double damping_rate_max = 0;
  /// Smallest ratio of damping to stiffness of any spring, s; 0 if a spring has no damper.
  double relaxation_min = 0;
  /// Lowest rate at which a node's own damper stops it, 1/s.
  double damping_rate_min = 0;
  bool converged = true;  ///< True if the values are bounds.
};

}  // namespace thimble::render
