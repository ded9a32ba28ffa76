#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "thimble/driver/result.h"

namespace thimble::scene {

/// Reads a whole regular file of at most `size_max` bytes. Fails, with the path in the sentence, on
/// a file that is absent, is no regular file (a folder, a pipe, a device), is larger, or cannot be
/// read. Never waits for a pipe, and never reads an endless file. `expected`: what the file should
/// be, as "a scene or an arm file". Real-time: never from the servo thread.
driver::Result<std::string> read_regular_file(const std::filesystem::path& file,
                                              std::uintmax_t size_max, std::string_view expected);

}  // namespace thimble::scene
