#pragma once

#include <memory>

#include "thimble/driver/result.h"
#include "view/feedback/feedback_outputs.h"

namespace thimble::view {

/// Opens the user's default sound card: ALSA's `default`, which PipeWire and PulseAudio provide if
/// they run. The error says what to do. Real-time: never from the servo thread.
driver::Result<std::unique_ptr<SoundOutput>> open_sound_card();

}  // namespace thimble::view
