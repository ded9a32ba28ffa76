#pragma once

#include <string>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Returns a text that a terminal can only display. A question mark replaces each control character
/// but line feed and tab (C0, DEL, C1). It also replaces each character that changes the direction
/// of text or breaks a line invisibly, and each byte that is not UTF-8 (RFC 3629). Real-time: never
/// from the servo thread.
THIMBLE_EXPORT std::string printable(std::string_view text);

/// As `printable`, for a name within a line: line feeds and tabs are replaced as well.
THIMBLE_EXPORT std::string printable_name(std::string_view text);

}  // namespace thimble::driver
