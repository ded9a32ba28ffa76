#pragma once

#include <stdexcept>
#include <utility>

#include "thimble/driver/result.h"

namespace thimble::python {

/// What becomes thimble.Error in Python: a sentence that tells the user what to do.
struct ThimbleError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Returns the value of a result, or throws its sentence.
template <class T>
T value_of(driver::Result<T> result) {
  if (!result) throw ThimbleError(result.error().message);
  return std::move(result).value();
}

}  // namespace thimble::python
