#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

#include "log/printed_text.h"

namespace thimble::session {

/// Prints as fmt::print does, but only printable characters, and ignores write errors
/// (scene::write_text). Real-time: never from the servo thread.
template <class... Args>
void print(std::FILE* file, fmt::format_string<Args...> format, Args&&... args) {
  scene::write_text(file, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace thimble::session
