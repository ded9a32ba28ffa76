#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "text/utf8.h"
#include "thimble/driver/result.h"

namespace thimble::python {

/// What becomes thimble.Error in Python: a sentence that tells the user what to do. Python takes
/// only UTF-8, and file names in a sentence may be anything.
struct ThimbleError : std::runtime_error {
  explicit ThimbleError(const std::string& sentence)
      : std::runtime_error(scene::as_utf8(sentence)) {}
};

/// What becomes thimble.ArgumentError in Python: an argument that names nothing that there is, or
/// misses its bounds.
struct ArgumentError : ThimbleError {
  using ThimbleError::ThimbleError;
};

/// Returns the value of a result, or throws its sentence.
template <class T>
T value_of(driver::Result<T> result) {
  if (!result) throw ThimbleError(result.error().message);
  return std::move(result).value();
}

/// Returns the value of a result that fails by what an argument says, or throws its sentence.
template <class T>
T named_by(driver::Result<T> result) {
  if (!result) throw ArgumentError(result.error().message);
  return std::move(result).value();
}

/// Returns the value of a result that was read from a file that an argument names, or throws its
/// sentence: of a file that is not there it is the argument's fault.
template <class T>
T read_from(const std::filesystem::path& file, driver::Result<T> result) {
  if (!result && !std::filesystem::exists(file)) throw ArgumentError(result.error().message);
  return value_of(std::move(result));
}

}  // namespace thimble::python
