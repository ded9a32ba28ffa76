#pragma once

#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/transport.h"

namespace thimble::driver::woody {

/// Checks, without sending anything, whether the board at the other end of a wire is a
/// WoodenHaptics board. Such a board sends unasked and numbers its reports, each one more than the
/// last [S woody-experimental main.cpp]. Other programs on the same mbed board have the same USB
/// ids and the same report descriptor, but behave differently. Succeeds after 20 consecutive
/// reports with such numbers. Fails after a second; the error states what arrived instead.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT Result<void> listen_for_board(Transport& wire, const Clock& clock);

}  // namespace thimble::driver::woody
