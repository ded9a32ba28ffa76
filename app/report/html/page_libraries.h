#pragma once

#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::report {

/// A third-party library that is included in a page.
struct PageLibrary {
  std::string name;     ///< In its makers' spelling.
  std::string package;  ///< Debian package.
  std::string script;   ///< JavaScript.
  std::string style;    ///< CSS; may be empty.
  std::string licence;  ///< With its copyrights, from the Debian package.
};

/// Reads the third-party libraries of a page: three.js and dygraphs, from javascript/ below each
/// folder of $XDG_DATA_DIRS (/usr/share), where Debian's libjs-three and libjs-dygraphs install
/// them. The error says what to install. Real-time: never from the servo thread.
driver::Result<std::vector<PageLibrary>> read_page_libraries();

}  // namespace thimble::report
