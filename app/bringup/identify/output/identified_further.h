#pragma once

#include <string>

#include "bringup/identify/identify.h"
#include "bringup/identify/output/identified_file.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Returns the text that `identified_text` made with what else was found of the arm, each with its
/// mark: period of the reports, watchdog of the firmware, saturation of the amplifiers, cogging and
/// ripple of the motors, and the wire's jitter where the file has that key. Friction that differs
/// by direction, which no key holds, and jitter that the file does not name are told in comments.
/// Fails as `identified_text` does. Real-time: never from the servo thread.
driver::Result<std::string> further_text(const std::string& text, const Identified& found,
                                         const IdentifiedMark& mark);

}  // namespace thimble::bringup
