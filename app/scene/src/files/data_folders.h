#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Returns what came with this program: PREFIX/share/thimble, or app/ of the sources it was built
/// in; else, for a program of somebody else, what came with the libraries that it was built with.
/// Empty if there is none. Real-time: never from the servo thread.
THIMBLE_EXPORT std::filesystem::path own_folder();

/// Returns the folders that hold scenes/ and arms/, in the order in which names are looked for
/// (shipped_files.h). Some may be missing, and `own_folder` may be empty. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT std::vector<std::filesystem::path> data_folders();

}  // namespace thimble::scene
