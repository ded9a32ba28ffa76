#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "math/double_double.h"
#include "math/elementary.h"

namespace thimble::math {

double hypot(double x, double y) noexcept {
  double most = std::abs(x), least = std::abs(y);
  if (!(most < HUGE_VAL && least < HUGE_VAL)) {
    return std::isinf(x) || std::isinf(y) ? std::numeric_limits<double>::infinity() : x + y;
  }
  if (most < least) std::swap(most, least);
  if (least <= most * 0x1p-54) return most;
  // Keeps squares and their parts normal.
  double scale = 1;
  if (most > 0x1p400) scale = 0x1p-700;
  if (most < 0x1p-300) scale = 0x1p700;
  most *= scale;
  least *= scale;
  const DoubleDouble root = square_root(exact_product(most, most) + exact_product(least, least));
  if (scale != 0x1p700 || root.hi >= 0x1p-322) return root.hi / scale;
  // A denormal number: the last place of the sum is that of the result.
  const double shift = 0x1p-322;
  const DoubleDouble sum = exact_sum(shift, root.hi);
  return ((sum.hi + (sum.lo + root.lo)) - shift) / scale;
}

double cbrt(double x) noexcept {
  if (x == 0 || !std::isfinite(x)) return x;
  double scale = 1, size = std::abs(x);
  if (size < 0x1p-900) {
    size *= 0x1p300;
    scale = 0x1p-100;
  }
  if (size > 0x1p900) {
    size *= 0x1p-300;
    scale = 0x1p100;
  }
  // A third of the exponent, to 5 bits, and three steps, each of which triples the number of bits.
  double root = std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) / 3 + 0x2a9f7893782da1ce);
  for (int i = 0; i < 3; ++i) {
    const double cube = root * root * root;
    root *= (cube + 2 * size) / (2 * cube + size);  // Halley, 1694
  }
  const DoubleDouble square = exact_product(root, root);
  const DoubleDouble rest = DoubleDouble{size, 0} - square * root;
  return std::copysign((DoubleDouble{root, 0} + rest.hi / (3 * square.hi)).hi * scale, x);
}

}  // namespace thimble::math
