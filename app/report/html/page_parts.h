#pragma once

#include <string_view>

namespace thimble::report {

// The files of app/report/html/parts, put into the program when it is built (embed_parts.cmake).

extern const std::string_view kPageHtml;    ///< page.html, with @NAMES@ for what is filled in.
extern const std::string_view kPageStyle;   ///< page.css
extern const std::string_view kPageScript;  ///< All scripts, in the order in which they are needed.

}  // namespace thimble::report
