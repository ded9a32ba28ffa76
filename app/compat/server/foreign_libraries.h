#pragma once

#include <sys/types.h>

#include <filesystem>
#include <set>
#include <string>

namespace thimble::compat {

/// Returns the paths of vendors' libraries that a process and its descendants have loaded from
/// another folder than `ours`: copies that a program brings with it, or finds by LD_PRELOAD, RPATH
/// or an absolute path. A program that uses them does not see the arms of `thimble exec`. Processes
/// of other users are skipped. Real-time: never from the servo thread.
std::set<std::string> foreign_libraries(pid_t process, const std::filesystem::path& ours);

}  // namespace thimble::compat
