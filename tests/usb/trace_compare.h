#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "usb/virtual_arm.h"

namespace thimble::usb_test {

/// Writes the trace of a driver: the number of refused messages, then one line per tick.
void write_trace(const std::vector<driver::TickRecord>& records, std::uint64_t refused,
                 const std::string& file);

/// Compares a driver's trace with that of `thimble plug --trace`. Every position of the driver is
/// one that the arm sent, in order, and correct within a count. Every message that the arm accepted
/// requests the force that the driver sent, within a quantum of the wire. Measures the delay from
/// encoder to force by the arm's own clock. Prints PASS or FAIL for each check; returns the number
/// of failures.
int compare_traces(const VirtualArm& arm, const std::string& driver_trace,
                   const std::string& device_trace);

}  // namespace thimble::usb_test
