#pragma once

#include <string>

#include "usb/virtual_arm.h"

namespace thimble::usb_test {

// Checks of a board before any contact. Each prints PASS or FAIL and returns the number of failed
// checks.

/// Prints the result of a check; returns 0 if it passed, else 1.
int verdict(bool pass, const std::string& what, const std::string& detail);

/// Compares ids, strings, interfaces and report descriptors in the kernel with those that the board
/// sent, and prints the node of the board.
int check_kernel(const VirtualArm& arm);

/// Compares the tip positions for fixed reports with those of the published programs.
int check_vectors(const VirtualArm& arm);

/// Opens the wire, sends nothing and counts the reports.
int check_unasked(const VirtualArm& arm);

/// Sends messages with the length of another board. Either the arm is not opened, or the run ends
/// with a fault.
int check_wrong_length(const VirtualArm& arm);

}  // namespace thimble::usb_test
