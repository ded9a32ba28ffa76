#pragma once

#include <cstdlib>
#include <string_view>

namespace thimble::support {

/// Returns whether tests run at full length (THIMBLE_LONG=1) instead of in their short form.
inline bool long_form() {
  const char* const asked = std::getenv("THIMBLE_LONG");
  return asked != nullptr && std::string_view(asked) == "1";
}

}  // namespace thimble::support
