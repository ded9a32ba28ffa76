#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Returns the length in bytes of the first character of a text; 0 if it is not UTF-8 [RFC 3629,
/// 4], or if the text is empty. Real-time: safe.
THIMBLE_EXPORT std::size_t utf8_length(std::string_view text) noexcept;

/// Returns a text in which each byte that is not UTF-8 (possible in file names) is replaced by
/// U+FFFD. Real-time: never from the servo thread.
THIMBLE_EXPORT std::string as_utf8(std::string_view text);

}  // namespace thimble::scene
