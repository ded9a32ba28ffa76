#pragma once

#include <string>

#include "thimble/driver/discovery.h"

namespace thimble::bringup {

// What a person is told of a board that may be an arm or anything else. Real-time: never from the
// servo thread.

/// Returns what is known of the board and why it is not used by itself. Precondition: it is of
/// unknown kind.
std::string what_it_may_be(const driver::FoundArm& board);

/// Returns what to do if the board is an arm: the rule that gives access, and the words to use it
/// by.
std::string how_to_use(const driver::FoundArm& board);

/// Returns the line of udev rules that lets the user at the screen open this very board: by its
/// serial number if that names it, else by its socket.
std::string udev_line(const driver::FoundArm& board);

}  // namespace thimble::bringup
