#pragma once

#include <filesystem>

#include "recording/read_recording.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Writes a recording as a table: a line that names the columns with their units
/// ("p_WT.x [m]"), then one per tick, numbers so that they read back to the bit.
/// Real-time: never from the servo thread.
driver::Result<void> write_csv(const Recording& recording, const std::filesystem::path& path);

}  // namespace thimble::session
