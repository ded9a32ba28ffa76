#include "report/html/page_libraries.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "text_file.h"

namespace thimble::report {
namespace {

namespace fs = std::filesystem;

struct Wanted {
  const char* name;
  const char* package;
  const char* script;
  const char* style;
};

constexpr std::array<Wanted, 2> kWanted{
    {{"three.js", "libjs-three", "three/three.min.js", ""},
     {"dygraphs", "libjs-dygraphs", "dygraphs/dygraph.min.js", "dygraphs/dygraph.min.css"}}};

std::vector<fs::path> share_folders() {
  std::vector<fs::path> folders;
  const char* named = std::getenv("XDG_DATA_DIRS");
  std::string_view rest = named != nullptr && *named != 0 ? named : "/usr/local/share:/usr/share";
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find(':'));
    if (!one.empty()) folders.emplace_back(one);
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
  }
  return folders;
}

// Reads the files of a package; returns whether it is complete.
bool read(const Wanted& wanted, const fs::path& share, PageLibrary& library) {
  const fs::path folder = share / "javascript";
  library = {.name = wanted.name,
             .package = wanted.package,
             .script = scene::text_of(folder / wanted.script),
             .style = *wanted.style == 0 ? "" : scene::text_of(folder / wanted.style),
             .licence = scene::text_of(share / "doc" / wanted.package / "copyright")};
  return !library.script.empty() && !library.licence.empty() &&
         (*wanted.style == 0 || !library.style.empty());
}

}  // namespace

driver::Result<std::vector<PageLibrary>> read_page_libraries() {
  std::vector<PageLibrary> libraries;
  std::string missing;
  for (const Wanted& wanted : kWanted) {
    PageLibrary library;
    bool found = false;
    for (const fs::path& share : share_folders()) {
      found = found || read(wanted, share, library);
      if (found) break;
    }
    if (found) {
      libraries.push_back(library);
    } else {
      missing += std::string(" ") + wanted.package;
    }
  }
  if (!missing.empty()) {
    return driver::Error{
        "the report page requires third-party libraries; install them with: apt install" + missing};
  }
  return libraries;
}

}  // namespace thimble::report
