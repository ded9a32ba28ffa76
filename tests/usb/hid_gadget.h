#pragma once

#include <string>

namespace thimble::usb_test {

/// Prints the HID report descriptor of a simulated arm, for the function of the gadget.
int print_report_descriptor(const std::string& arm);

/// Runs an arm behind the kernel's own HID gadget: reads messages from the function's node
/// (/dev/hidg0) and writes a report each millisecond, until it is killed. The kernel is both host
/// and device, without USB/IP in between.
int run_gadget(const std::string& arm, const std::string& node);

}  // namespace thimble::usb_test
