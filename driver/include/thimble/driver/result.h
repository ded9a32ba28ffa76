#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace thimble::driver {

/// Error of a set-up path: the problem, its place and the fix.
///
/// `message` consists of one or two full sentences, ready to print ("No access to 1234:0006:
/// install udev/70-thimble.rules and replug the arm.").
struct Error {
  std::string message;  ///< Problem and fix in one or two sentences.
};

/// A value, or the Error that explains why there is none. Only for set-up paths.
///
/// Precondition of `value()` is `ok()`, of `error()` it is `!ok()`. A violation throws
/// std::bad_variant_access. Real-time: never from the servo thread.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}      // NOLINT
  Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}  // NOLINT

  bool ok() const { return content_.index() == 0; }  ///< Returns whether there is a value.
  explicit operator bool() const { return ok(); }    ///< As `ok`.

  T& value() & { return std::get<0>(content_); }                ///< Returns the value.
  const T& value() const& { return std::get<0>(content_); }     ///< Returns the value.
  T&& value() && { return std::get<0>(std::move(content_)); }   ///< Returns the value.
  const Error& error() const { return std::get<1>(content_); }  ///< Returns the error.

  T* operator->() { return &value(); }              ///< As `value`.
  const T* operator->() const { return &value(); }  ///< As `value`.
  T& operator*() & { return value(); }              ///< As `value`.
  const T& operator*() const& { return value(); }   ///< As `value`.

 private:
  std::variant<T, Error> content_;
};

/// Success of a set-up step, or the Error that explains the failure.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT

  bool ok() const { return !error_.has_value(); }        ///< Returns whether the step succeeded.
  explicit operator bool() const { return ok(); }        ///< As `ok`.
  const Error& error() const { return error_.value(); }  ///< Returns the error.

 private:
  std::optional<Error> error_;
};

}  // namespace thimble::driver
