#include "surface/law/law_formula.h"

namespace thimble::render {

driver::Result<std::unique_ptr<LawFormula>> LawFormula::make(const std::string&,
                                                             const std::vector<LawParameter>&) {
  return driver::Error{
      "formulas are not in this program: it was built without muParser. Install libmuparser-dev "
      "and "
      "build again with THIMBLE_FORMULAS=ON"};
}

}  // namespace thimble::render
