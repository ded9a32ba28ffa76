#pragma once

#include <filesystem>
#include <vector>

#include "recording/recording_info.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// Is a recording in memory.
struct Recording {
  RecordingInfo info;
  std::vector<driver::TickRecord> ticks;
  bool complete = false;  ///< False if it was cut off, by a crash or a full disk.
};

/// Reads a recording, complete or cut off. The error says what the file is not, or which part of it
/// makes no sense. Real-time: never from the servo thread.
driver::Result<Recording> read_recording(const std::filesystem::path& path);

}  // namespace thimble::session
