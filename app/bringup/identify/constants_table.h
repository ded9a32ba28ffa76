#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bringup/identify/identify.h"

namespace thimble::bringup {

/// A constant in a form for users.
struct ConstantRow {
  std::string name;
  Estimate found;               ///< Value in `unit`.
  std::string unit;             ///< Unit, printed after the numbers.
  std::optional<double> named;  ///< Value in the arm file, in the same unit, if any.
};

/// Returns all constants that were found, including those of link and firmware. `file`: the file
/// with which the arm was identified.
std::vector<ConstantRow> constant_rows(const Identified& identified, const scene::ArmFile& file);

/// Returns the basis of a fit: its number of pieces, and the share that it explains.
std::string fit_text(const Identified& identified);

/// Returns the table of the constants with their intervals, their basis, and the constants that
/// were not identified.
std::string constants_table(const Identified& identified, const scene::ArmFile& file);

}  // namespace thimble::bringup
