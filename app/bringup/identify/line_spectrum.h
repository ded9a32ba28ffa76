#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "bringup/identify/arm_motion.h"
#include "math/elementary.h"

namespace thimble::bringup {

/// What one frequency of a motion shows, or of what is beside it: how far torques and joints
/// oscillate there, joint by joint.
struct SpectralLine {
  double omega = 0;                                 ///< rad/s
  Eigen::Vector3cd tau = Eigen::Vector3cd::Zero();  ///< N m, held from tick to tick
  Eigen::Vector3cd q = Eigen::Vector3cd::Zero();    ///< rad
};

/// The lines of a motion under LineForces, and the noise about them.
struct LineSpectrum {
  std::vector<SpectralLine> lines;
  /// Frequencies between the lines, kBeside for each line, in its order: what they show beyond the
  /// model's answer to their own torques is noise.
  std::vector<SpectralLine> beside;
  static constexpr std::size_t kBeside = 8;
  Eigen::Matrix3d JTJ = Eigen::Matrix3d::Zero();  ///< Mean of J^T J over the motion, m^2.
};

/// Returns e^(i angle).
inline std::complex<double> turn_by(double angle) {
  return {math::cos(angle), math::sin(angle)};
}

/// Takes a motion apart into its lines: whole periods of LineForces under Hann's window. Lines in
/// which too little was recorded, or with ticks without a report, are shown as they were seen.
/// Empty if the motion is shorter than a period. Real-time: never from the servo thread.
LineSpectrum line_spectrum(const ArmMotion& motion);

}  // namespace thimble::bringup
