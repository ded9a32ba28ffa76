#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bringup/doctor.h"
#include "thimble/driver/discovery.h"

namespace thimble::bringup {

// What the doctor finds of arms that are reached by their vendors' services. Opens and changes
// nothing. Real-time: never from the servo thread.

/// Returns what to do with an arm on USB whose protocol is not public.
std::string mend_for_closed(const driver::FoundArm& arm);

/// Returns whether an arm behind a service can be used, and what it tells of its versions.
Finding examine_linked(const driver::FoundArm& arm);

/// Returns whether the user may open the node of an arm on USB through which its vendor's library
/// reaches it, below `root`, and what to do if not: our udev rule is for arms that we open
/// ourselves.
Finding examine_access(const driver::FoundArm& arm, const std::filesystem::path& root);

/// Returns what keeps a service away whose arm is on USB: `arms` are all that were found.
std::vector<Finding> examine_services(const std::vector<driver::FoundArm>& arms);

/// Returns what keeps the vendor's library from a Touch among `arms`, as far as the files and
/// programs below `root` tell: a ModemManager that runs, a libncurses5 that is missing. Empty
/// without a Touch.
std::vector<Finding> examine_touch(const std::vector<driver::FoundArm>& arms,
                                   const std::filesystem::path& root);

}  // namespace thimble::bringup
