#pragma once

#include "thimble/driver/discovery.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// Returns the model number that a board on USB serial answers with when it is asked with zero
/// currents (1 Polhem, 2 vintage PHANTOM, 3 WoodenHaptics). Writes only to a board whose USB
/// product string says that it is a Haptikfabriken arm; for any other it fails and leaves the port
/// alone. The error says what to do. Real-time: never from the servo thread.
driver::Result<int> ask_board_model(const driver::FoundArm& arm);

}  // namespace thimble::scene
