#pragma once

#include <string>

#include "thimble/driver/discovery.h"

namespace thimble::bringup {

// Advice about a board that may or may not be an arm. Real-time: never from the servo thread.

/// Returns the known facts about the board and the reason why it is not used automatically.
/// Precondition: it is of unknown kind.
std::string what_it_may_be(const driver::FoundArm& board);

/// Returns the steps to take if the board is an arm: the udev rule that gives access, and the
/// options that select it.
std::string how_to_use(const driver::FoundArm& board);

/// Returns the udev rule that lets the user at the screen open exactly this board: by its serial
/// number if that identifies it, else by its socket.
std::string udev_line(const driver::FoundArm& board);

}  // namespace thimble::bringup
