#pragma once

#include <memory>
#include <string>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "vendors/hd/hd_library.h"

namespace thimble::driver::hd {

/// Opens the link to the default device of the library. Frame B: x right, y up, z to the user. The
/// library's scheduler owns the thread. Once per tick of the scheduler, in one frame, the link
/// reads position, velocity, transform and buttons and sends the newest force of the loop. A force
/// expires after 20 ms without a new one.
///
/// Forces are enabled only for a calibrated arm; any other is refused (`calibrate`). The library
/// has one scheduler for all links: while a link works, no other can be opened. A lost link is shut
/// down before its successor opens the device.
///
/// No force exceeds the library's nominal one. At the end: zero force in a frame, then the
/// scheduler stops, and the device is released.
///
/// Errors in the frame: after an error of forces (warm motors, exceeded force or velocity) the
/// force is zero. Writes are then refused until a tenth of a second has passed without one. After
/// an error of the device or the communication the arm is lost. After any other error the report is
/// rejected. Real-time: never from the servo thread. `clock` is the loop's, and outlives the link.
THIMBLE_EXPORT Result<std::unique_ptr<ArmLink>> open_link(const Library& library, Clock& clock);

/// Returns the instruction for the user before `calibrate`, depending on the device's calibration
/// style.
THIMBLE_EXPORT Result<std::string> how_to_calibrate(const Library& library);

/// Calibrates the default device, after the user has followed `how_to_calibrate`. Real-time: never
/// from the servo thread; takes seconds.
THIMBLE_EXPORT Result<void> calibrate(const Library& library);

}  // namespace thimble::driver::hd
