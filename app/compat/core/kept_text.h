#pragma once

#include <mutex>
#include <set>
#include <string>
#include <string_view>

namespace thimble::compat {

/// Returns the address of an equal text that is valid until the process ends, as the C functions
/// that return texts promise. It may be called from any thread.
inline const char* kept_text(std::string_view text) {
  static std::mutex mutex;
  // Never destroyed, because a program may print a text while it exits.
  static auto& texts = *new std::set<std::string>;
  const std::lock_guard lock(mutex);
  return texts.emplace(text).first->c_str();
}

}  // namespace thimble::compat
