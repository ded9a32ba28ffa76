#pragma once

#include <string>

#include "usb/virtual_arm.h"

namespace thimble::usb_test {

// What is true of a board before anybody touches it. Each says PASS or FAIL and returns how many
// checks failed.

/// Prints how a check went; returns 0 if it passed, else 1.
int verdict(bool pass, const std::string& what, const std::string& detail);

/// Compares ids, strings, interfaces and report descriptors, as the kernel shows them, with those
/// that the board sent, and says which node it got.
int check_kernel(const VirtualArm& arm);

/// Compares where fixed reports put the tip with what the published programs make of them.
int check_vectors(const VirtualArm& arm);

/// Opens the wire, says nothing and counts what comes.
int check_unasked(const VirtualArm& arm);

/// Sends messages of another board's length. Either nobody opens the arm that way, or the run ends
/// with a named fault.
int check_wrong_length(const VirtualArm& arm);

}  // namespace thimble::usb_test
