#pragma once

#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::report {

/// A library of other people's that is put into a page.
struct PageLibrary {
  std::string name;     ///< As its makers write it.
  std::string package;  ///< Debian's.
  std::string script;   ///< JavaScript.
  std::string style;    ///< CSS; may be empty.
  std::string licence;  ///< With its copyrights, as Debian keeps it.
};

/// Reads what a page needs of other people: three.js and dygraphs, from javascript/ below each
/// folder of $XDG_DATA_DIRS (/usr/share), where Debian's libjs-three and libjs-dygraphs put them.
/// The error says what to install. Real-time: never from the servo thread.
driver::Result<std::vector<PageLibrary>> read_page_libraries();

}  // namespace thimble::report
