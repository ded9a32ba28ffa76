#pragma once

#include <memory>
#include <vector>

#include "setup.h"
#include "share/live_knobs.h"
#include "share/run_sharing.h"
#include "share/shared_run.h"
#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Creates the memory through which viewers see a run and change its knobs, as requested by
/// `options`. It has no name for viewers in this process only, or a name for all. If the name is
/// that of the scene and is taken, a number is appended. `before`: a run that is over, whose name
/// it takes; or null. The error is that of SharedRun::create. Real-time: never from the servo
/// thread.
driver::Result<std::unique_ptr<SharedRun>> share_run(const Setup& setup, const LiveKnobs& knobs,
                                                     const SessionOptions& options,
                                                     SharedRun* before = nullptr);

/// Returns the objects with permanent deformation, with their places in the shared tables.
/// Real-time: never from the servo thread.
std::vector<RunSharing::Shaped> shaped_objects(const Setup& setup);

}  // namespace thimble::session
