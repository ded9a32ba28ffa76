#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace thimble::bringup {

/// Small forces at many single frequencies, each along one axis, that show where an arm's cables
/// and links resonate: an odd random-phase multisine [M Pintelon and Schoukens, System
/// Identification]. All frequencies are odd multiples of kBase, and no two are alike, so that what
/// else moves the tip (dry friction, bent geometry) is seen beside them. Frame W: world.
class LineForces {
 public:
  static constexpr int kLines = 16;     ///< Per axis.
  static constexpr double kBase = 0.5;  ///< Hz
  /// Hz [chosen: above what the slow sines and their friction reach; below the half of 1 kHz].
  static constexpr double kLowest = 15, kHighest = 380;

  /// Takes what the phases are drawn by.
  explicit LineForces(std::uint64_t seed);

  /// Returns the force (N) at a time since the beginning (s). Real-time: safe.
  Eigen::Vector3d force(double time) const noexcept;

  /// Returns the frequency of a line, Hz. Real-time: safe.
  static double frequency(int axis, int line) noexcept;

 private:
  std::array<std::array<double, kLines>, 3> phase_{};
};

}  // namespace thimble::bringup
