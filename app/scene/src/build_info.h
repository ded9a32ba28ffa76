#pragma once

#include <string>
#include <string_view>

namespace thimble::scene {

/// Says which build of the program made a report.
struct BuildInfo {
  std::string_view version;
  std::string_view compiler;
  std::string_view type;      ///< CMake's build type.
  std::string_view revision;  ///< Of the source when the build was configured; empty if unknown.
};

/// Tells what this build is.
BuildInfo build_info();

/// Tells the same in one line: two programs with the same one feel the same to the bit on one
/// machine, if neither was built from changed sources.
std::string program_name();

}  // namespace thimble::scene
