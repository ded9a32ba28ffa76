#pragma once

#include <atomic>

#include "terminal.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Lets nobody be surprised by a force: says which real arm of a session is about to get forces,
/// and waits until the user agrees. `agreed`: he did so by --yes. Returns false if he does not, if
/// nobody can be asked, or once `stop` is set; a simulated arm needs nobody. Real-time: never from
/// the servo thread.
THIMBLE_EXPORT bool agree_to_forces(const Session& session, bool agreed, const Terminal& terminal,
                                    const std::atomic<bool>& stop);

/// Opens the arm of a session on which all else is ready; a real one may have forces only once its
/// tip is where it must be (wait_for_start_pose). Returns false if `stop` was set before.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<bool> open_arm(Session& session, const Terminal& terminal,
                                             const std::atomic<bool>& stop);

}  // namespace thimble::session
