#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace thimble::session {

/// Prints as fmt::print does, but lets a write that fails be: whoever prints may hold an arm, which
/// an exception would leave with its last force, and a terminal that is gone is no reason for that.
/// Real-time: never from the servo thread.
template <class... Args>
void print(std::FILE* file, fmt::format_string<Args...> format, Args&&... args) {
  std::fputs(fmt::format(format, std::forward<Args>(args)...).c_str(), file);
}

}  // namespace thimble::session
