#pragma once

#include <string>

#include "thimble/driver/export.h"

namespace thimble::session {

/// A measured value with its goal, from a run, report, study or benchmark.
struct THIMBLE_EXPORT Figure {
  std::string name;    ///< Name in lower_snake_case.
  double value = 0;    ///< Value in `unit`.
  std::string unit;    ///< Unit; empty for counts.
  std::string goal;    ///< Goal as a comparison (">= 20", "<= 5", "== 0", "> 1", "< 2"); empty if
                       ///< there is none.
  std::string note{};  ///< Source of the value, or why it has no goal; may be empty.

  /// Returns whether the value meets the goal; true without a goal. NaN meets no goal. A goal that
  /// is not a comparison is never met.
  bool met() const;
};

}  // namespace thimble::session
