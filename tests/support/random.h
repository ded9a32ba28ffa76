#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

#include "support/seed.h"

namespace thimble::support {

/// Draws numbers that are the same with every standard library: raw bits of the Mersenne twister,
/// scaled here.
class Random {
 public:
  /// The random cases of a test, which have a number: fresh ones in the long form (seed_of).
  explicit Random(int cases) : Random(seed_of(static_cast<std::uint64_t>(cases))) {}
  /// Numbers that follow from this seed in every form.
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  std::uint64_t bits() { return bits_(); }

  /// Draws from [low, high).
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
