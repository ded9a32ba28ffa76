#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace thimble::bringup {

/// Small forces at many single frequencies, each along one axis, that show the resonances of an
/// arm's cables and links. They are an odd random-phase multisine [M Pintelon and Schoukens, System
/// Identification]. All frequencies are different odd multiples of kBase, so that other causes of
/// motion (dry friction, nonlinear geometry) appear between them. Frame W: world.
class LineForces {
 public:
  static constexpr int kLines = 16;     ///< Per axis.
  static constexpr double kBase = 0.5;  ///< Hz
  /// Hz [chosen: above the slow sines and the effect of their friction; below half of 1 kHz].
  static constexpr double kLowest = 15, kHighest = 380;

  /// Takes the seed of the phases.
  explicit LineForces(std::uint64_t seed);

  /// Returns the force (N) at a time since the beginning (s). Real-time: safe.
  Eigen::Vector3d force(double time) const noexcept;

  /// Returns the frequency of a line, Hz. Real-time: safe.
  static double frequency(int axis, int line) noexcept;

 private:
  std::array<std::array<double, kLines>, 3> phase_{};
};

}  // namespace thimble::bringup
