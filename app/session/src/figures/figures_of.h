#pragma once

#include "run_records.h"
#include "setup.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/session/run_figures.h"

namespace thimble::session {

/// Returns the figures of a run, of one of its arms (from 0): `end` is why it ended, `grant` what
/// the kernel granted the servo's thread. Looks through the trace for contacts that were lost.
/// Real-time: never from the servo thread.
RunFigures figures_of(const Setup& setup, std::size_t arm, const RunRecords& records,
                      driver::ServoEnd end, const driver::RealTimeGrant& grant);

}  // namespace thimble::session
