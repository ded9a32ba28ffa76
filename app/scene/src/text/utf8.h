#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Returns how many bytes the character at the beginning of a text has; 0 if it is not UTF-8
/// [RFC 3629, 4], or if the text is empty. Real-time: safe.
THIMBLE_EXPORT std::size_t utf8_length(std::string_view text) noexcept;

/// Returns a text in which each byte that is not UTF-8 is replaced by U+FFFD, as file names may
/// hold. Real-time: never from the servo thread.
THIMBLE_EXPORT std::string as_utf8(std::string_view text);

}  // namespace thimble::scene
