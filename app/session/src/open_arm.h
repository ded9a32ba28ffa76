#pragma once

#include <atomic>

#include "terminal.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/session/session.h"

namespace thimble::session {

/// Announces which real arm of a session is about to get forces, and waits until the user agrees.
/// `agreed` is true after --yes. Returns false if the user does not agree, if there is no terminal,
/// or once `stop` is set. Returns true at once for a simulated arm. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT bool agree_to_forces(const Session& session, bool agreed, const Terminal& terminal,
                                    const std::atomic<bool>& stop);

/// Opens the arm of a prepared session. A real arm is activated only once its tip is at the start
/// pose (wait_for_start_pose). Returns false if `stop` was set before. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT driver::Result<bool> open_arm(Session& session, const Terminal& terminal,
                                             const std::atomic<bool>& stop);

}  // namespace thimble::session
