#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace thimble::view {

/// The numbers at an axis: round ones (1, 2 or 5 times a power of ten apart).
struct AxisTicks {
  double first = 0;       ///< The least.
  double step = 1;        ///< From one to the next.
  std::size_t count = 0;  ///< How many there are.
  int decimals = 0;       ///< That tell each from the next.

  double at(std::size_t i) const { return first + static_cast<double>(i) * step; }
  double last() const { return at(count == 0 ? 0 : count - 1); }
  /// Writes one of them; never "-0".
  std::string text(std::size_t i) const;
};

/// Returns the round numbers from `least` to `most`, at most `most_count` (>= 2) of them and as
/// many as fit. None if there are no numbers between, or one of them is not finite.
AxisTicks ticks_within(double least, double most, std::size_t most_count);

/// Returns round numbers that reach from no more than `least` to no less than `most`, at most
/// `most_count` (>= 3) of them: for an axis that shall end at numbers.
AxisTicks ticks_around(double least, double most, std::size_t most_count);

/// A unit that something is told in, and how many of them one in SI is.
struct ShownUnit {
  const char* name;
  double per_si;
};

/// What is measured: in which units it is told.
enum class Quantity { kForce, kLength, kTime, kSpeed };

/// Returns the unit in which numbers up to `most` (SI) are read best: N or mN; mm or um; s, ms or
/// us; mm/s or um/s.
ShownUnit unit_for(Quantity quantity, double most);

/// Writes a value (SI) with a unit that fits it, three digits: "2.31 N", "840 um".
std::string with_unit(Quantity quantity, double value);

}  // namespace thimble::view
