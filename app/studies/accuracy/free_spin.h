#pragma once

#include <Eigen/Core>

namespace thimble::studies {

/// A body that spins freely near its middle axis, where it turns over repeatedly.
struct FreeSpin {
  Eigen::Vector3d inertia{1e-4, 2e-4, 2.6e-4};  ///< kg m^2, ascending, about the body's axes
  Eigen::Vector3d omega{0.2, 12, 0.5};          ///< rad/s at 0, in the body
};

/// Returns the true angular velocity (rad/s, in the body) at `t` s by Jacobi's elliptic functions
/// [M Landau and Lifshitz, Mechanics, section 37]. Real-time: never from the servo thread.
Eigen::Vector3d true_rate(const FreeSpin& spin, double t);

}  // namespace thimble::studies
