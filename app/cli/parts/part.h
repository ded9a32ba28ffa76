#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

#include "thimble/driver/result.h"

namespace thimble::cli {

/// A part of Thimble that a build or an installation may lack.
struct Part {
  const char* option;   ///< The CMake option that builds it; empty: every full build has it.
  const char* package;  ///< Its Debian package, and the name of the program with its commands,
                        ///< which `thimble` starts; empty: its commands are in `thimble`.
};

inline constexpr Part kStudies{"THIMBLE_STUDIES", "thimble-studies"};
inline constexpr Part kViewer{"THIMBLE_VIEW", "thimble-viewer"};
inline constexpr Part kCommissioning{"THIMBLE_COMMISSIONING", ""};
inline constexpr Part kCompat{"THIMBLE_COMPAT", ""};
inline constexpr Part kTools{"", ""};  ///< Missing in the build of app/demo.sh.

/// Returns the path of the file `name` in the first of `places` that has it; empty if none has.
/// Places are relative to the folder of the running program. Real-time: never from the servo
/// thread.
std::filesystem::path find_beside_program(const std::string& name,
                                          std::initializer_list<const char*> places);

/// Returns the program of a part: next to this one in a build folder, in libexec if installed;
/// empty if there is none. Real-time: never from the servo thread.
std::filesystem::path part_program(const Part& part);

/// Returns the program `thimble`, from that of a part: the reverse of `part_program`. Real-time:
/// never from the servo thread.
std::filesystem::path main_program();

/// Returns how to get a part, as the end of a sentence without its full stop.
std::string how_to_get(const Part& part);

/// Keeps the arguments of this process for `start_part`. `argv`: that of `main`.
void keep_arguments(char** argv);

/// Replaces this process by `program`, with the same arguments. Returns only on failure. Real-time:
/// never from the servo thread.
driver::Error start_part(const std::filesystem::path& program);

}  // namespace thimble::cli
