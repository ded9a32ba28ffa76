#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "thimble/driver/result.h"

namespace thimble::support {

/// Returns whether a result is an error whose message contains these words.
template <class T>
testing::AssertionResult refuses(const driver::Result<T>& result, std::string_view words) {
  if (result) return testing::AssertionFailure() << "the result is no error";
  const std::string& said = result.error().message;
  if (said.find(words) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << words << "' is not in '" << said << "'";
}

}  // namespace thimble::support
