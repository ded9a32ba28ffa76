#pragma once

#include <filesystem>

#include "thimble/driver/result.h"

namespace thimble::compat {

/// Returns the folder of the compatibility libraries, relative to this program: installed, or in a
/// build tree. It is in no default search path, so that the original vendor libraries remain
/// usable. The error says what to install. Real-time: never from the servo thread.
driver::Result<std::filesystem::path> library_folder();

}  // namespace thimble::compat
