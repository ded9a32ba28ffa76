#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bringup/doctor.h"
#include "thimble/driver/discovery.h"

namespace thimble::bringup {

// Findings about arms behind their vendors' services. Opens and changes nothing. Real-time: never
// from the servo thread.

/// Returns the remedy for an arm on USB whose protocol is not public.
std::string access_fix(const driver::FoundArm& arm);

/// Returns whether an arm behind a service can be used, and its versions.
Finding examine_linked(const driver::FoundArm& arm);

/// Returns whether the user may open the node through which a vendor's library reaches an arm on
/// USB, below `root`, and the remedy if not. Our udev rule covers only arms that we open ourselves.
Finding examine_access(const driver::FoundArm& arm, const std::filesystem::path& root);

/// Returns the problems of a service whose arm is on USB; `arms` are all arms found.
std::vector<Finding> examine_services(const std::vector<driver::FoundArm>& arms);

/// Returns problems of the vendor's library with a Touch among `arms`, from the files and programs
/// below `root`: a running ModemManager, a missing libncurses5. Empty without a Touch.
std::vector<Finding> examine_touch(const std::vector<driver::FoundArm>& arms,
                                   const std::filesystem::path& root);

}  // namespace thimble::bringup
