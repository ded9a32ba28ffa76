#pragma once

#include <string>

namespace thimble::usb_test {

/// Prints the HID report descriptor of a simulated arm, for the gadget's function to show.
int print_report_descriptor(const std::string& arm);

/// The arm behind the kernel's own HID gadget: takes messages from the function's node
/// (/dev/hidg0) and gives it a report a millisecond, until it is killed. The kernel is both the
/// host and the device then, with no USB/IP in between.
int be_gadget(const std::string& arm, const std::string& node);

}  // namespace thimble::usb_test
