#pragma once

#include <filesystem>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Writes a recording as a ROS bag (bag/write_bag.h) in the world's frame: /pose, where the tip
/// was; /wrench, the force that was sent; /wrench_wanted, what the scene asked for before the gate.
/// A message per tick, stamped by the loop's clock. The error says what cannot be written.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> export_bag(const Recording& recording,
                                               const std::filesystem::path& folder);

}  // namespace thimble::session
