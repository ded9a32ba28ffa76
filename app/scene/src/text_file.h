#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace thimble::scene {

/// Reads a file as it is; empty if it cannot be read. Real-time: never from the servo thread.
inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace thimble::scene
