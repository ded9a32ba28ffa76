#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace thimble::driver {

/// Makes continuous counts of encoder counters that wrap around after a number of bits. The first
/// counts are the reference: each is taken as the value nearest to zero. From then on a counter
/// moves the shorter way round.
///
/// A step of more than a quarter of the range is refused, and the counts before it remain the
/// reference. From half the range on, the direction of a step would be the wrong one. The margin of
/// a quarter detects such steps unless they are close to a whole range. Real-time: safe.
class CountUnwrap {
 public:
  /// Replaces counters by continuous counts; those with zero bits do not wrap. Returns false, and
  /// changes nothing, if a step is refused. Precondition: at most 31 bits.
  bool take(const std::array<std::uint8_t, 3>& bits, std::array<std::int32_t, 3>& counts) noexcept {
    std::array<std::int32_t, 3> fresh = counts;
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      if (bits[i] == 0) continue;
      const std::int32_t before = any_ ? last_[i] : 0;
      const std::int64_t step = low_bits(counts[i], before, bits[i]);
      const std::int64_t limit = std::int64_t{1} << (bits[i] - 2);
      if (any_ && (step > limit || step < -limit)) return false;
      const std::int64_t count = before + step;
      if (count > kCountMax || count < -kCountMax) return false;
      fresh[i] = static_cast<std::int32_t>(count);
    }
    any_ = true;
    counts = last_ = fresh;
    return true;
  }

 private:
  /// Largest continuous count. [chosen: half of 32 bits, so that nothing overflows]
  static constexpr std::int64_t kCountMax = std::int64_t{1} << 30;

  /// Returns the lowest bits of a difference in two's complement.
  static std::int64_t low_bits(std::int32_t a, std::int32_t b, unsigned bits) noexcept {
    const auto difference = static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b);
    const unsigned shift = 32U - bits;
    return static_cast<std::int32_t>(difference << shift) >> shift;
  }

  std::array<std::int32_t, 3> last_{};  // continuous counts of the last report
  bool any_ = false;
};

}  // namespace thimble::driver
