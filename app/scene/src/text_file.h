#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "system/regular_file.h"

namespace thimble::scene {

/// Returns the contents of a file; empty if it cannot be read, is not a regular file or is larger
/// than allowed for a scene or arm file. Real-time: never from the servo thread.
inline std::string text_of(const std::filesystem::path& file) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 20;
  auto text = driver::read_file(file, kMaxBytes);
  return text ? std::move(text).value() : std::string();
}

}  // namespace thimble::scene
