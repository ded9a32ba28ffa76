#include "hil/median_interval.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace thimble::hil {
namespace {

constexpr double kOutside = 0.025;  // on either side

/// Returns the index from either end, from 0 on, of the values that bound the median of `count`.
std::size_t rank_from_end(std::size_t count) {
  const double n = static_cast<double>(count);
  double chance = std::exp2(-n);  // that exactly `rank` values lie on one side
  double below = chance;
  std::size_t rank = 0;
  while (rank + 1 < count / 2) {
    chance *= (n - static_cast<double>(rank)) / static_cast<double>(rank + 1);
    if (below + chance > kOutside) break;
    below += chance;
    ++rank;
  }
  return rank;
}

}  // namespace

MedianInterval median_interval(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t count = values.size(), rank = rank_from_end(count);
  return {.median = 0.5 * (values[(count - 1) / 2] + values[count / 2]),
          .low = values[rank],
          .high = values[count - 1 - rank]};
}

}  // namespace thimble::hil
