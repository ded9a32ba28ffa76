#pragma once

#include <string>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Identification of a build of Thimble.
struct BuildInfo {
  std::string_view version;   ///< Version, as in CMakeLists.txt.
  std::string_view compiler;  ///< Compiler name and version.
  std::string_view type;      ///< CMake build type.
  std::string_view revision;  ///< Source revision at configuration; empty if unknown.
};

/// Returns the identification of this build.
THIMBLE_EXPORT BuildInfo build_info();

/// Returns the identification in one line. Two programs with the same line give bit-identical
/// results on one machine, unless one was built from modified sources.
THIMBLE_EXPORT std::string program_name();

}  // namespace thimble::scene
