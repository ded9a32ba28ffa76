#pragma once

#include <memory>
#include <string>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "vendors/dhd/dhd_library.h"

namespace thimble::driver::dhd {

/// Opens the link to the only arm of the library. Frame B: x to the user, y right, z up. A thread
/// of the link exchanges data with the arm, as often as the library allows (some kHz). It reads
/// position, velocity, orientation, gripper and buttons, and sends the newest force of the loop. A
/// force expires after 20 ms without a new one.
///
/// Forces are enabled only for an arm that knows its zero. Otherwise the arm is refused, because it
/// would have to move by itself to find its zero (`find_zero`). Before the first force: watchdog,
/// gravity compensation, brakes off, force on. At the end: zero force, force off, stop, close.
///
/// A read that fails is rejected. A failed exchange, or a force that is not accepted, makes the
/// link lost. While the library has switched the forces off, writes are refused. The library has
/// one arm for all links: while a link works, no other can be opened. A lost link is shut down
/// before its successor opens the arm.
///
/// Fails if there is no arm; if there is more than one, since nothing selects one of them; and
/// while another link of this program works. Real-time: never from the servo thread. `clock` is the
/// loop's, and outlives the link.
THIMBLE_EXPORT Result<std::unique_ptr<ArmLink>> open_link(const Library& library, Clock& clock);

/// Lets the only arm of the library move by itself until it has found its zero. The user must agree
/// first, release the arm and keep away. Real-time: never from the servo thread; takes seconds.
THIMBLE_EXPORT Result<void> find_zero(const Library& library);

}  // namespace thimble::driver::dhd
