#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "usb/virtual_arm.h"

namespace thimble::usb_test {

/// Writes what a driver did: how many messages the wire refused, then a line a tick.
void write_trace(const std::vector<driver::TickRecord>& records, std::uint64_t refused,
                 const std::string& file);

/// Compares a driver's trace with that of `thimble plug --trace`: every position that the driver
/// saw is one that the arm sent, in order, and right within a count; every message that the arm
/// took asks for the force that the driver sent, within a quantum of the wire. Measures the delay
/// from encoder to force by the arm's own clock. Says PASS or FAIL for each; returns how many
/// failed.
int compare_traces(const VirtualArm& arm, const std::string& driver_trace,
                   const std::string& device_trace);

}  // namespace thimble::usb_test
