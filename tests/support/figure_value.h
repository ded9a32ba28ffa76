#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "report/figure_output.h"

namespace thimble::support {

/// Returns the value of the figure with this name; -1 if there is none.
inline double figure_value(const std::vector<session::Figure>& figures, const std::string& name) {
  const auto found = std::find_if(figures.begin(), figures.end(),
                                  [&](const session::Figure& one) { return one.name == name; });
  return found == figures.end() ? -1 : found->value;
}

}  // namespace thimble::support
