#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/arm_link.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

// How a scene comes to a real arm. Real-time: never from the servo thread.

/// Returns one of the boards that are plugged in. `wanted`: "sim" gives none; "auto" the only one
/// that is an arm which Thimble can drive, or none if there is none; else the one of that name (see
/// `thimble devices`), even if it is of unknown kind, as long as it can be driven. The error says
/// what to do.
THIMBLE_EXPORT driver::Result<std::optional<driver::FoundArm>> choose_arm(
    const std::vector<driver::FoundArm>& plugged_in, const std::string& wanted);

/// Returns a sentence about the boards of unknown kind that "auto" leaves out, and how to use one;
/// empty if there are none.
THIMBLE_EXPORT std::string boards_left_out(const std::vector<driver::FoundArm>& plugged_in);

/// Returns the same arm after it was pulled, by the name that it had: its serial number, or its
/// socket where that names none. Empty if it is not there, cannot be told from another, or cannot
/// be opened yet.
THIMBLE_EXPORT std::optional<driver::FoundArm> find_again(
    const std::vector<driver::FoundArm>& plugged_in, const driver::FoundArm& lost);

/// Returns an error if an arm file may not be used with a board, which it must name: currents and
/// signs of one are dangerous on another.
THIMBLE_EXPORT driver::Result<void> check_fits(const ArmFile& file, const driver::FoundArm& arm);

/// Opens the link to an arm, for this program alone, and brings the arm up: a Falcon gets its
/// firmware (from the file the user named, or not at all) and is homed by the user's hand, for
/// which it prints what to do; a WoodenHaptics on its mbed board must show by its reports that it
/// is one before anything is sent; a board on USB serial must be the one that the file is for; a
/// service must show by its first message that it is Haply's and has this arm.
THIMBLE_EXPORT driver::Result<std::unique_ptr<driver::ArmLink>> open_link(
    const driver::FoundArm& arm, const ArmFile& file, const std::filesystem::path& firmware,
    driver::Clock& clock);

}  // namespace thimble::scene
