#pragma once

#include <string>

#include "thimble/driver/export.h"

namespace thimble::session {

/// One number that a run, report, study or bench stands for, and what it should be.
struct THIMBLE_EXPORT Figure {
  std::string name;  ///< In lower_snake_case.
  double value = 0;  ///< In `unit`.
  std::string unit;  ///< Empty for numbers of things.
  std::string goal;  ///< A comparison in text (">= 20", "<= 5", "== 0", "> 1", "< 2"); empty: none.
  std::string note{};  ///< Where the value was found, or why nothing is asked of it; may be empty.

  /// Returns whether the value meets the goal; a figure without one is met. NaN meets no goal, and
  /// nothing meets a goal that is no comparison.
  bool met() const;
};

}  // namespace thimble::session
