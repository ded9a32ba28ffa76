#pragma once

#include <filesystem>
#include <memory>

#include "thimble/driver/result.h"
#include "view/feedback/feedback_outputs.h"

namespace thimble::view {

/// Opens the first gamepad that can rumble, by the kernel's force feedback (evdev, FF_RUMBLE).
/// `folder`: folder of the event files. The kernel stops the motors kRumbleMax after the last
/// command, and when this object is destroyed or its process dies. The error says what to do.
/// Real-time: never from the servo thread.
driver::Result<std::unique_ptr<RumbleOutput>> open_rumble(
    const std::filesystem::path& folder = "/dev/input");

}  // namespace thimble::view
