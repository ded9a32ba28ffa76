#include "thimble/session/run_figures.h"

#include <sstream>

namespace thimble::session {

bool Figure::met() const {
  if (goal.empty()) return true;
  std::istringstream text(goal);
  std::string comparison;
  double bound = 0;
  if (!(text >> comparison >> bound)) return false;
  if (comparison == ">=") return value >= bound;
  if (comparison == "<=") return value <= bound;
  if (comparison == "==") return value == bound;
  if (comparison == ">") return value > bound;
  if (comparison == "<") return value < bound;
  return false;
}

}  // namespace thimble::session
