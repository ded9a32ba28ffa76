#pragma once

#include <string>

#include "bringup/identify/identify.h"
#include "bringup/identify/output/identified_file.h"
#include "thimble/driver/result.h"

namespace thimble::bringup {

/// Adds further results to the text of `identified_text`, each with its mark. They are report
/// period, firmware watchdog, saturation of the amplifiers, cogging and ripple of the motors, and
/// the wire's jitter if the file has that key. Comments give friction that differs by direction,
/// which no key holds, and jitter that the file does not name. Fails like `identified_text`.
/// Real-time: never from the servo thread.
driver::Result<std::string> further_text(const std::string& text, const Identified& found,
                                         const IdentifiedMark& mark);

}  // namespace thimble::bringup
