#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

#include "support/seed.h"

namespace thimble::support {

/// Draws numbers that are equal with every standard library: raw bits of the Mersenne twister,
/// scaled here.
class Random {
 public:
  /// Takes the number of a test's random cases. In the long form the cases are new in each run
  /// (seed_of).
  explicit Random(int cases) : Random(seed_of(static_cast<std::uint64_t>(cases))) {}
  /// Takes a seed; the numbers are the same in both forms.
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  std::uint64_t bits() { return bits_(); }

  /// Draws a number from [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53;
  }

  Eigen::Vector3d in_box(double half_side) {
    return {uniform(-half_side, half_side), uniform(-half_side, half_side),
            uniform(-half_side, half_side)};
  }

  Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d v = in_box(1);
      const double n = v.norm();
      if (n > 0.1 && n <= 1) return v / n;
    }
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace thimble::support
