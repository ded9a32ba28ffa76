#pragma once

#include "report/report.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/session/session.h"

namespace thimble::app {

/// Sums a session up after its run: `end` is why that ended, `grant` what the kernel granted its
/// thread. Looks through the trace for contacts that were lost. Real-time: never from the servo
/// thread.
RunReport report_of(const session::Session& session, driver::ServoEnd end,
                    const driver::RealTimeGrant& grant);

}  // namespace thimble::app
