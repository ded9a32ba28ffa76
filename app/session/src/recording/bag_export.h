#pragma once

#include <filesystem>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Writes a recording as a ROS bag (bag/write_bag.h) in the world's frame. Topics are /pose, the
/// position of the tip; /wrench, the force sent; and /wrench_wanted, the force requested by the
/// scene before the gate. One message per tick and topic, stamped with the loop's clock. The error
/// says what cannot be written. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> export_bag(const Recording& recording,
                                               const std::filesystem::path& folder);

}  // namespace thimble::session
