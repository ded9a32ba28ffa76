#pragma once

#include <string>

#include "usb/virtual_arm.h"

namespace thimble::usb_test {

/// Compares the requested forces of a program under `thimble exec` with those that the servo got:
/// each force of the recording (`thimble export --csv`) is one that the program logged, in order.
/// `axes` selects the program's numbers for x, y and z of the world, for example "zxy". Writes a
/// trace for `compare_traces`, in which the force of a tick is that of the program if the gate had
/// to pass it unchanged. Returns the number of errors.
int trace_of_program(const VirtualArm& arm, const std::string& log, const std::string& axes,
                     const std::string& recording, const std::string& trace);

}  // namespace thimble::usb_test
