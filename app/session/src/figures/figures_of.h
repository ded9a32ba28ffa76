#pragma once

#include <vector>

#include "run_records.h"
#include "setup.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/session/run_figures.h"

namespace thimble::session {

/// Returns the trackers of the objects that are meshes in memory; none under a tip with a radius.
/// Real-time: never from the servo thread.
std::vector<RunFigures::Tracker> trackers_of(const Setup& setup);

/// Returns the figures of one arm (from 0) of a run. `end`: end reason of the run; `grant`:
/// real-time properties granted to the servo's thread. Searches the trace for lost contacts.
/// Real-time: never from the servo thread.
RunFigures figures_of(const Setup& setup, std::size_t arm, const RunRecords& records,
                      driver::ServoEnd end, const driver::RealTimeGrant& grant);

}  // namespace thimble::session
