#pragma once

#include <filesystem>

#include "thimble/driver/result.h"

namespace thimble::compat {

/// Returns the folder of the libraries that stand in for others', found from where this program
/// lies: installed, or in a build tree. It is on nobody's search path, so that the owner of another
/// maker's arm keeps that maker's library. The error says what to install. Real-time: never from
/// the servo thread.
driver::Result<std::filesystem::path> face_folder();

}  // namespace thimble::compat
