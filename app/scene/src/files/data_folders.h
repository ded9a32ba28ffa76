#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// Returns the data folder of this program: PREFIX/share/thimble, or app/ of the sources from which
/// it was built. For another program it is that of the libraries with which it was built. Empty if
/// there is none. Real-time: never from the servo thread.
THIMBLE_EXPORT std::filesystem::path own_folder();

/// Returns the folders with scenes/ and arms/, in search order (shipped_files.h). Some may be
/// missing, and `own_folder` may be empty. Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<std::filesystem::path> data_folders();

}  // namespace thimble::scene
