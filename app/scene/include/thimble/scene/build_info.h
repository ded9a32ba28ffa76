#pragma once

#include <string>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Which build of Thimble this is.
struct BuildInfo {
  std::string_view version;   ///< As in CMakeLists.txt.
  std::string_view compiler;  ///< Name and version.
  std::string_view type;      ///< CMake's build type.
  std::string_view revision;  ///< Of the source when the build was configured; empty if unknown.
};

/// Returns what this build is.
THIMBLE_EXPORT BuildInfo build_info();

/// Returns the same in one line: two programs with the same one feel the same to the bit on one
/// machine, if neither was built from changed sources.
THIMBLE_EXPORT std::string program_name();

}  // namespace thimble::scene
