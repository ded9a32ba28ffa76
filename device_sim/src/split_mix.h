#pragma once

#include <cstdint>

namespace thimble::device_sim {

/// Random numbers by SplitMix64 (Steele, Lea, Flood 2014): bit-identical on every platform, which
/// the distributions of the standard library do not promise. Real-time: safe.
class SplitMix {
 public:
  /// Starts the sequence of a seed.
  explicit SplitMix(std::uint64_t seed) noexcept : state_(seed) {}

  /// Returns the next number, uniform from 0 to below 1.
  double uniform() noexcept {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace thimble::device_sim
