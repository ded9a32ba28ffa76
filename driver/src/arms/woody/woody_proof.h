#pragma once

#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/transport.h"

namespace thimble::driver::woody {

/// Listens whether the far end of a wire is a WoodenHaptics board, and sends nothing. The board
/// sends by itself and numbers its reports, each one more than the last [S woody-experimental
/// main.cpp]; other programs on the same mbed board have the same USB ids and the same report
/// descriptor, and do something else. Succeeds after 20 reports in a row that are numbered so;
/// fails after a second, with a sentence that says what came instead. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT Result<void> listen_for_board(Transport& wire, const Clock& clock);

}  // namespace thimble::driver::woody
