#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "text/utf8.h"
#include "thimble/driver/result.h"

namespace thimble::python {

/// thimble.Error in Python: a message with the problem and its remedy. Invalid UTF-8 is replaced,
/// because Python accepts only UTF-8 but file names may contain any bytes.
struct ThimbleError : std::runtime_error {
  explicit ThimbleError(const std::string& sentence)
      : std::runtime_error(scene::as_utf8(sentence)) {}
};

/// thimble.ArgumentError in Python: an argument that names nothing that exists, or is out of range.
struct ArgumentError : ThimbleError {
  using ThimbleError::ThimbleError;
};

/// Returns the value of a result, or throws its error.
template <class T>
T value_of(driver::Result<T> result) {
  if (!result) throw ThimbleError(result.error().message);
  return std::move(result).value();
}

/// Returns the value of a result, or throws its error as that of an argument.
template <class T>
T named_by(driver::Result<T> result) {
  if (!result) throw ArgumentError(result.error().message);
  return std::move(result).value();
}

/// Returns the value of a result read from a file that an argument names, or throws its error. A
/// missing file is an error of the argument.
template <class T>
T read_from(const std::filesystem::path& file, driver::Result<T> result) {
  if (!result && !std::filesystem::exists(file)) throw ArgumentError(result.error().message);
  return value_of(std::move(result));
}

}  // namespace thimble::python
