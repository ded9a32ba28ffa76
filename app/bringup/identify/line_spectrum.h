#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "bringup/identify/arm_motion.h"
#include "math/elementary.h"

namespace thimble::bringup {

/// One frequency of a motion, on or between the lines: oscillation of torques and joints, joint by
/// joint.
struct SpectralLine {
  double omega = 0;                                 ///< rad/s
  Eigen::Vector3cd tau = Eigen::Vector3cd::Zero();  ///< N m, held from tick to tick
  Eigen::Vector3cd q = Eigen::Vector3cd::Zero();    ///< rad
};

/// The lines of a motion under LineForces, and the noise between them.
struct LineSpectrum {
  std::vector<SpectralLine> lines;
  /// Frequencies between the lines, kBeside for each line, in its order. Their motion, without the
  /// model's response to their own torques, is noise.
  std::vector<SpectralLine> noise_lines;
  static constexpr std::size_t kNoiseLines = 8;
  Eigen::Matrix3d JTJ = Eigen::Matrix3d::Zero();  ///< Mean of J^T J over the motion, m^2.
};

/// Returns e^(i angle).
inline std::complex<double> turn_by(double angle) {
  return {math::cos(angle), math::sin(angle)};
}

/// Computes the lines of a motion: whole periods of LineForces under Hann's window. Lines with too
/// little data, or with ticks without a report, are returned as measured. Empty if the motion is
/// shorter than a period. Real-time: never from the servo thread.
LineSpectrum line_spectrum(const ArmMotion& motion);

}  // namespace thimble::bringup
