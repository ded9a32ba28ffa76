#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bringup/identify/identify.h"

namespace thimble::bringup {

/// One constant as people read it.
struct ConstantRow {
  std::string name;
  Estimate found;               ///< In its unit.
  std::string unit;             ///< With what it counts, behind the numbers.
  std::optional<double> named;  ///< What the arm file says, in the same unit, if it says anything.
};

/// Returns all constants that were found, those of link and firmware too. `file`: what the arm was
/// identified with.
std::vector<ConstantRow> constant_rows(const Identified& identified, const scene::ArmFile& file);

/// Returns what a fit rests on: how many pieces, and what it explains.
std::string fit_text(const Identified& identified);

/// Returns the table of the constants with their intervals, what they rest on, and what was not
/// identified.
std::string constants_table(const Identified& identified, const scene::ArmFile& file);

}  // namespace thimble::bringup
