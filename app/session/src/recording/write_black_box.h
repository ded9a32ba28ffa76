#pragma once

#include <filesystem>
#include <span>

#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// How many black boxes are kept; the oldest go first.
inline constexpr std::size_t kBlackBoxesMax = 50;

/// Writes the ticks around a fault as a recording into the user's state folder and tells where;
/// the name holds scene, fault and time. Real-time: never from the servo thread.
driver::Result<std::filesystem::path> write_black_box(std::span<const driver::TickRecord> ticks,
                                                      const RecordingInfo& info);

}  // namespace thimble::session
