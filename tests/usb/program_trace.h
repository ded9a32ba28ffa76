#pragma once

#include <string>

#include "usb/virtual_arm.h"

namespace thimble::usb_test {

/// Compares what a program of `thimble exec` asked for with what the servo was given: each force of
/// the recording (`thimble export --csv`) is one that the program logged, in order. `axes` says
/// which of the program's numbers are x, y and z of the world, such as "zxy". Writes a trace
/// for `compare_traces` in which each tick's force is the program's own wherever the gate was
/// to let all of it through. Returns how much was wrong.
int trace_of_program(const VirtualArm& arm, const std::string& log, const std::string& axes,
                     const std::string& recording, const std::string& trace);

}  // namespace thimble::usb_test
