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
/// of the link's own speaks with the arm, as often as the library lets it (some kHz): it reads
/// position, velocity, orientation, gripper and buttons, and sends the newest force of the loop,
/// which it drops after 20 ms without a new one.
///
/// Forces are enabled only for an arm that knows its zero: one that does not is refused, for it
/// would move by itself to find it (`find_zero`). Before the first force: watchdog, gravity
/// compensation, brakes off, force on. At the end: zero force, force off, stop, close.
///
/// A read that fails is rejected; a failed exchange, or a force that is not taken, loses the arm.
/// While the library has the forces off by itself, writes are refused.
/// The library has one arm for all links: while a link works no other can be opened, and a lost one
/// is shut down before its successor opens the arm.
///
/// Fails if there is no arm, or more than one: nothing says which of them is meant; and while
/// another link of this program works.
/// Real-time: never from the servo thread. `clock` is the loop's, and outlives the link.
THIMBLE_EXPORT Result<std::unique_ptr<ArmLink>> open_link(const Library& library, Clock& clock);

/// Lets the only arm of the library move by itself until it has found its zero. Only after a word
/// of the user, who must let it go and keep away. Real-time: never from the servo thread; takes
/// seconds.
THIMBLE_EXPORT Result<void> find_zero(const Library& library);

}  // namespace thimble::driver::dhd
