#pragma once

#include <string_view>

#include "share/shared_reader.h"
#include "thimble/driver/result.h"

namespace thimble::web {

/// Sends a command of a page to the run, through the same requests as the window and `thimble view
/// RUN`. Commands: "pause", "resume", "restart", "step N" or "turn KNOB=VALUE". The error says that
/// the run refuses and why, that it no longer answers, or that the command is unknown. For example,
/// a run with a real arm does not restart. Real-time: never from the servo thread.
driver::Result<void> steer_run(session::SharedReader& reader, std::string_view request);

}  // namespace thimble::web
