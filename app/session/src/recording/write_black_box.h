#pragma once

#include <filesystem>
#include <span>

#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Largest number of black boxes kept; the oldest are deleted first.
inline constexpr std::size_t kBlackBoxesMax = 50;

/// Writes the ticks around a fault as a recording into the user's state folder and returns its
/// path. The name contains scene, fault and time. Real-time: never from the servo thread.
driver::Result<std::filesystem::path> write_black_box(std::span<const driver::TickRecord> ticks,
                                                      const RecordingInfo& info);

}  // namespace thimble::session
