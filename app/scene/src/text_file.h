#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace thimble::scene {

/// Reads a file as it is; empty if it cannot be read or is no regular file: a pipe would be waited
/// for. Real-time: never from the servo thread.
inline std::string text_of(const std::filesystem::path& file) {
  std::error_code status;
  if (!std::filesystem::is_regular_file(file, status)) return {};
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace thimble::scene
