#pragma once

#include <string>

namespace thimble::view {

/// A unit in which people read a quantity, and how many of the SI unit it is.
struct ReadUnit {
  const char* name;  ///< "um"
  double size;       ///< 1e-6
};

/// Returns the unit in which a length (m) or a force (N) is read best whose largest value is
/// `most`: um below 1 mm, mm above, mN below 0.1 N, N above. Other units are left as they are.
ReadUnit read_unit(const std::string& unit, double most);

/// Writes a length (m) or a force (N) in its unit with a fixed number of characters, so that a
/// number that changes does not jump: " 1.23 mm", "123.4 um", "-0.40 N ". What is not finite is a
/// dash as wide. Above the range (999 mm, 99 N) it is wider.
std::string length_text(double length);
std::string force_text(double force);

/// Writes a force (N) as short as it can be: "2 N", "50 mN".
std::string plain_force(double force);

}  // namespace thimble::view
