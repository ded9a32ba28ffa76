#pragma once

#include <filesystem>
#include <string>

#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/real_arm_file.h"

namespace thimble::scene {

// What a passed feel check says, it says of one arm as it was then: its name, its arm file with the
// calibration, what the driver makes of both, and its firmware. A record is kept per arm in
// state_folder()/feel_checks. It holds against mistakes, not against a user who forges his own.
// Real-time: never from the servo thread.

/// An arm as a feel check found it.
struct CheckedArm {
  std::string name;      ///< What `thimble devices` calls it.
  std::string arm_file;  ///< Name and checksum of the installed arm file's text.
  std::string data;      ///< Checksum of calibration, poses and messages.
  std::string firmware;  ///< What is known of the firmware; empty: too little for a record.
};

/// Returns what a real arm is now. `arm` is its file with the calibration; `firmware` is the image
/// that the user named, without which the firmware of a Falcon is not known.
THIMBLE_EXPORT CheckedArm describe_checked(const driver::FoundArm& found, const RealArmFile& arm,
                                           const std::filesystem::path& firmware);

/// Returns the file that holds the record of an arm of this name.
THIMBLE_EXPORT std::filesystem::path feel_check_file(const std::string& name);

/// Returns whether this arm, as it is, passed a feel check. A record that is damaged, of something
/// else or of another user counts as none.
THIMBLE_EXPORT bool has_passed(const CheckedArm& arm);

/// Keeps that an arm passed: written whole or not at all. Fails, with a sentence, where its
/// firmware is not known or the file cannot be written.
THIMBLE_EXPORT driver::Result<void> keep_passed(const CheckedArm& arm);

/// Removes the record of an arm that failed. Fails if it is there and stays.
THIMBLE_EXPORT driver::Result<void> forget_passed(const std::string& name);

}  // namespace thimble::scene
