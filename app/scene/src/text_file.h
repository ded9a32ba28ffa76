#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "system/regular_file.h"

namespace thimble::scene {

/// Reads a file as it is; empty if it cannot be read, is no regular file or is larger than a scene
/// or an arm may be. Real-time: never from the servo thread.
inline std::string text_of(const std::filesystem::path& file) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 20;
  auto text = driver::read_file(file, kMaxBytes);
  return text ? std::move(text).value() : std::string();
}

}  // namespace thimble::scene
