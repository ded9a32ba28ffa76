#pragma once

#include <filesystem>
#include <string>

#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/real_arm_file.h"

namespace thimble::scene {

// A passed feel check is valid for one arm in one state: its name, its arm file with the
// calibration, the driver's results for both, and its firmware. One record per arm is stored in
// state_folder()/feel_checks. It protects against mistakes, not against forgery by the user.
// Real-time: none of these functions may be called from the servo thread.

/// State of an arm at a feel check.
struct CheckedArm {
  std::string name;      ///< Name of the arm in `thimble devices`.
  std::string arm_file;  ///< Name and checksum of the installed arm file's text.
  std::string data;      ///< Checksum of calibration, poses and messages.
  /// Firmware of the arm; empty if it is not known well enough for a record.
  std::string firmware;
};

/// Returns the current state of a real arm. `arm` is its file with the calibration. `firmware` is
/// the image that the user named; without it the firmware of a Falcon is unknown.
THIMBLE_EXPORT CheckedArm describe_checked(const driver::FoundArm& found, const RealArmFile& arm,
                                           const std::filesystem::path& firmware);

/// Returns the path of the record of an arm.
THIMBLE_EXPORT std::filesystem::path feel_check_file(const std::string& name);

/// Returns whether this arm passed a feel check in its current state. A record that is damaged, of
/// another state or of another user is ignored.
THIMBLE_EXPORT bool has_passed(const CheckedArm& arm);

/// Saves atomically that an arm passed. Fails if its firmware is unknown or the file cannot be
/// written.
THIMBLE_EXPORT driver::Result<void> save_feel_check(const CheckedArm& arm);

/// Removes the record of an arm that failed. Fails if it exists and cannot be removed.
THIMBLE_EXPORT driver::Result<void> remove_feel_check(const std::string& name);

}  // namespace thimble::scene
