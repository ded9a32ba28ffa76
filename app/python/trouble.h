#pragma once

#include <stdexcept>
#include <utility>

#include "thimble/driver/result.h"

namespace thimble::python {

/// Is what becomes thimble.Error in Python: a sentence that tells the user what to do.
struct Trouble : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Gives the value of a result, or throws its sentence.
template <class T>
T value_of(driver::Result<T> result) {
  if (!result) throw Trouble(result.error().message);
  return std::move(result).value();
}

}  // namespace thimble::python
