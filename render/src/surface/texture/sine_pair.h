#pragma once

#include <bit>
#include <cstdint>

namespace thimble::render {

/// Two numbers that every processor computes at once.
using Pair = double __attribute__((vector_size(16)));

/// Sines and cosines of two angles.
struct SinePair {
  Pair sine, cosine;
};

/// Returns them for angles in quarters of a turn of at most 2^50 either way, to 2e-16. NaN gives
/// NaN. Bit-identical on every processor: only products, sums and integers. A texture needs many at
/// once; `math::sin_cos` is also exact in the last digits of small sines. Real-time: safe.
inline SinePair sine_pair(Pair quarters) noexcept {
  using Words = std::int64_t __attribute__((vector_size(16)));
  // Adding this rounds to an integer, whose lowest bits are those of the sum.
  constexpr double kWhole = 0x1.8p52;
  const Pair shifted = quarters + kWhole;
  const Pair x = (quarters - (shifted - kWhole)) * 0x1.921fb54442d18p+0;  // pi / 2: an eighth turn
  const Pair x2 = x * x;
  // Taylor's series, enough up to pi / 4: the next terms are below 5e-17.
  constexpr double kSine[] = {1,           -1. / 6,        1. / 120,        -1. / 5040,
                              1. / 362880, -1. / 39916800, 1. / 6227020800, -1. / 1307674368000};
  constexpr double kCosine[] = {1,
                                -1. / 2,
                                1. / 24,
                                -1. / 720,
                                1. / 40320,
                                -1. / 3628800,
                                1. / 479001600,
                                -1. / 87178291200,
                                1. / 20922789888000};
  Pair sine = kSine[7] * x2 + kSine[6];
  for (int i = 5; i > 0; --i) sine = sine * x2 + kSine[i];
  sine = x + x * x2 * sine;
  Pair cosine = kCosine[8] * x2 + kCosine[7];
  for (int i = 6; i >= 0; --i) cosine = cosine * x2 + kCosine[i];
  // In the odd quarters sine and cosine are exchanged; in two of the four each changes its sign.
  const Words quarter = std::bit_cast<Words>(shifted), odd = -(quarter & 1);
  const Words s = std::bit_cast<Words>(sine), c = std::bit_cast<Words>(cosine);
  const Words sign = {INT64_MIN, INT64_MIN};
  return {std::bit_cast<Pair>(((odd & c) | (~odd & s)) ^ (quarter << 62 & sign)),
          std::bit_cast<Pair>(((odd & s) | (~odd & c)) ^ ((quarter + 1) << 62 & sign))};
}

}  // namespace thimble::render
