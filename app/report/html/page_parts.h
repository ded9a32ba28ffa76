#pragma once

#include <string_view>

namespace thimble::report {

// The files of app/report/html/parts, compiled into the program (embed_parts.cmake).

extern const std::string_view kPageHtml;    ///< page.html, with @NAMES@ as placeholders.
extern const std::string_view kPageStyle;   ///< page.css
extern const std::string_view kPageScript;  ///< All scripts, in the required order.

}  // namespace thimble::report
