#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace thimble::scene {

/// Returns whether an arm file seems to describe a wire: it has a line that begins with "wire:".
/// Quicker than reading the file. Real-time: never from the servo thread.
inline bool names_described_wire(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line)) {
    if (line.starts_with("wire:")) return true;
  }
  return false;
}

}  // namespace thimble::scene
