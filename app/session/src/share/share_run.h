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

/// Makes the memory by which viewers see a run and turn its knobs, as `options` asks: without a
/// name for viewers in this process, or under a name for all; where the scene gives the name, a
/// second run of it gets a number. `before`: a run that is over, whose name it takes; or null. The
/// error is that of SharedRun::create. Real-time: never from the servo thread.
driver::Result<std::unique_ptr<SharedRun>> share_run(const Setup& setup, const LiveKnobs& knobs,
                                                     const SessionOptions& options,
                                                     SharedRun* before = nullptr);

/// Returns the objects whose vertices move for good, as they lie in what is shared. Real-time:
/// never from the servo thread.
std::vector<RunSharing::Shaped> shaped_objects(const Setup& setup);

}  // namespace thimble::session
