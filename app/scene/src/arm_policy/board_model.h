#pragma once

#include "thimble/driver/discovery.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// Returns the model number of a board on USB serial, which it sends in reply to a message with
/// zero currents (1 Polhem, 2 vintage PHANTOM, 3 WoodenHaptics). Writes only to a board whose USB
/// product string identifies a Haptikfabriken arm; for any other it fails without opening the port.
/// The error says what to do. Real-time: never from the servo thread.
driver::Result<int> ask_board_model(const driver::FoundArm& arm);

}  // namespace thimble::scene
