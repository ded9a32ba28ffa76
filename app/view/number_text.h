#pragma once

#include <string>

namespace thimble::view {

/// A display unit of a quantity, and its size in the SI unit.
struct ReadUnit {
  const char* name;  ///< "um"
  double size;       ///< 1e-6
};

/// Returns a readable unit for a length (m) or a force (N) with largest value `most`: um below 1
/// mm, mm above, mN below 0.1 N, N above. Other units stay unchanged.
ReadUnit read_unit(const std::string& unit, double max);

/// Returns a length (m) or a force (N) as text with a fixed number of characters, so that a
/// changing number does not move: " 1.23 mm", "123.4 um", "-0.40 N ". A number that is not finite
/// is a dash of the same width. Above the range (999 mm, 99 N) the text is wider.
std::string length_text(double length);
std::string force_text(double force);

/// Returns a force (N) as the shortest text: "2 N", "50 mN".
std::string plain_force(double force);

}  // namespace thimble::view
