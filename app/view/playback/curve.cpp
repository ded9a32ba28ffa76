#include "view/playback/curve.h"

#include <algorithm>

namespace thimble::view {

void Extent::add(const Extent& other) {
  min = std::min(min, other.min);
  max = std::max(max, other.max);
}

std::size_t Curve::first_at(double time) const {
  std::size_t low = 0;
  std::size_t high = size();
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (this->time(middle) < time) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

Extent Curve::extent(const TimeRange& range) const {
  std::size_t to = first_at(range.end);
  while (to < size() && time(to) <= range.end) ++to;
  return extent(first_at(range.begin), to);
}

std::optional<double> Curve::value_at(double time) const {
  // Ticks are whole nanoseconds, so a smaller difference is the same time.
  constexpr double kSame = 0.5e-9;
  if (size() == 0 || !(time >= this->time(0) - kSame && time <= this->time(size() - 1) + kSame)) {
    return {};
  }
  const std::size_t after = first_at(time + kSame);
  if (after == 0) return {};
  return static_cast<double>(value(after - 1));
}

}  // namespace thimble::view
