#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

#include "math/elementary.h"

namespace thimble::stability {

/// Random numbers that are identical with every standard library: raw bits of the Mersenne twister,
/// scaled here. Real-time: never from the servo thread.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}

  std::uint64_t bits() { return bits_(); }
  /// Returns a number from [low, high).
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53;
  }
  /// Returns a number from [low, high), log-uniform; both bounds above 0.
  double octave(double low, double high) { return low * math::pow(high / low, uniform(0, 1)); }
  /// Returns true with this probability.
  bool chance(double probability) { return uniform(0, 1) < probability; }
  /// Returns an integer from 0 to count - 1.
  std::size_t one_of(std::size_t count) { return static_cast<std::size_t>(bits_() % count); }
  Eigen::Vector3d in_box(double half_side) {
    const double x = uniform(-half_side, half_side);
    const double y = uniform(-half_side, half_side);
    return {x, y, uniform(-half_side, half_side)};
  }
  Eigen::Vector3d direction() {
    while (true) {
      const Eigen::Vector3d v = in_box(1);
      const double length = v.norm();
      if (length > 0.1 && length <= 1) return v / length;
    }
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace thimble::stability
