#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::app {

/// Is one number that a report, study or bench stands for, and what it should be.
struct Figure {
  std::string name;
  double value = 0;
  std::string unit;
  std::string goal;  ///< A comparison in text (">= 20", "<= 5", "== 0", "> 1", "< 2"); empty: none.

  /// Tells whether the value meets the goal; a figure without one is met. NaN meets no goal, and
  /// nothing meets a goal that is no comparison.
  bool met() const;
};

/// Writes figures as JSON: a list of {"name", "value", "unit", "goal", "met"}; "goal" and "met" are
/// left out where there is no goal. Fails if the file cannot be written.
driver::Result<void> write_figures(const std::vector<Figure>& figures,
                                   const std::filesystem::path& file);

/// Lays figures out as a table in text, one per line.
std::string figure_table(const std::vector<Figure>& figures);

/// Writes a whole file. Fails, naming it, if that cannot be done.
driver::Result<void> write_text(const std::string& text, const std::filesystem::path& file);

}  // namespace thimble::app
