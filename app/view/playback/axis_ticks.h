#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace thimble::view {

/// The numbers at an axis: round ones (1, 2 or 5 times a power of ten apart).
struct AxisTicks {
  double first = 0;       ///< The smallest number.
  double step = 1;        ///< Distance of two numbers.
  std::size_t count = 0;  ///< The number of ticks of the axis.
  int decimals = 0;       ///< Decimals needed to distinguish the numbers.

  double at(std::size_t i) const { return first + static_cast<double>(i) * step; }
  double last() const { return at(count == 0 ? 0 : count - 1); }
  /// Returns one of them as text; never "-0".
  std::string text(std::size_t i) const;
};

/// Returns the round numbers from `least` to `most`, as many as possible up to `max_count` (>= 2).
/// Empty if there are no numbers between, or a bound is not finite.
AxisTicks ticks_within(double min, double max, std::size_t max_count);

/// Returns up to `max_count` (>= 3) round numbers whose range includes `least` and `most`, for an
/// axis that ends at numbers.
AxisTicks ticks_around(double min, double max, std::size_t max_count);

/// A display unit, and how many of them one SI unit is.
struct ShownUnit {
  const char* name;
  double per_si;
};

/// Measured quantities and their display units.
enum class Quantity { kForce, kLength, kTime, kSpeed };

/// Returns a readable unit for numbers up to `most` (SI): N or mN; mm or um; s, ms or us;
/// mm/s or um/s.
ShownUnit unit_for(Quantity quantity, double max);

/// Returns a value (SI) as text with a suitable unit, three digits: "2.31 N", "840 um".
std::string with_unit(Quantity quantity, double value);

}  // namespace thimble::view
