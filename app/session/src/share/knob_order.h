#pragma once

#include <string>

#include "share/shared_reader.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Turns the knob of an order "NAME=VALUE" of `thimble view --turn`. The error names the knobs that
/// there are, or the bounds that the value misses. Real-time: never from the servo thread.
driver::Result<void> turn_knob(SharedReader& reader, const std::string& order);

}  // namespace thimble::session
