#pragma once

#include <string_view>

#include "share/shared_reader.h"
#include "thimble/driver/result.h"

namespace thimble::web {

/// Asks of a run what a page asks, by the same requests as the window and `thimble view RUN`:
/// "pause", "resume", "restart", "step N" or "turn KNOB=VALUE". The error says why the run cannot
/// (a physical arm is not begun anew, say), that it hears nothing any more, or that these are no
/// such words. Real-time: never from the servo thread.
driver::Result<void> steer_run(session::SharedReader& reader, std::string_view request);

}  // namespace thimble::web
