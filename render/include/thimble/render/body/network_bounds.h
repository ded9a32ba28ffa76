#pragma once

namespace thimble::render {

/// Bounds how fast a spring network moves, found when it is built.
struct NetworkBounds {
  /// The highest natural frequency, rad/s: Lanczos' iteration on the masses and springs, to 1e-8 or
  /// told by `converged`; its remainder is added, so that it does not err to the low side.
  double omega_max = 0;
  /// A cheap bound that cannot be too low (Gershgorin: row sums), rad/s; 2 valence k / m under the
  /// root for springs alone [PHYSICS 4].
  double omega_gershgorin = 0;
  /// The highest rate at which dampers stop a node, 1/s: the same of masses and dampers.
  double damping_rate_max = 0;
  /// The least damping over stiffness of any spring, s; 0 if a spring has no damper.
  double relaxation_min = 0;
  /// The least rate at which a node's own damper stops it, 1/s.
  double damping_rate_min = 0;
  bool converged = true;  ///< Whether these are bounds.
};

}  // namespace thimble::render
