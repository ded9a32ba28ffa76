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

// Selection and opening of real arms. Real-time: never from the servo thread.

/// Lists the connected boards as driver::find_arms does, and recognises those that installed arm
/// files describe. An installed file with a mistake is ignored with a warning.
THIMBLE_EXPORT driver::Result<std::vector<driver::FoundArm>> find_arms(
    const std::filesystem::path& root = "/");

/// Returns one of the connected boards. `wanted` = "sim" returns none. "auto" returns the only
/// board that is an arm which Thimble can drive, or none if there is no such board. Otherwise
/// `wanted` is a name from `thimble devices`; a board of unknown kind is accepted if it can be
/// driven. The error says what to do.
THIMBLE_EXPORT driver::Result<std::optional<driver::FoundArm>> choose_arm(
    const std::vector<driver::FoundArm>& plugged_in, const std::string& wanted);

/// Returns a sentence that lists the boards of unknown kind which "auto" ignores, and how to use
/// one; empty if there are none.
THIMBLE_EXPORT std::string boards_left_out(const std::vector<driver::FoundArm>& plugged_in);

/// Returns the arm after a reconnection, found by its previous name: serial number, or USB socket
/// if there is none. Empty if it is not connected, ambiguous, or cannot be opened yet.
THIMBLE_EXPORT std::optional<driver::FoundArm> find_again(
    const std::vector<driver::FoundArm>& plugged_in, const driver::FoundArm& lost);

/// Fails if an arm file does not list the board of an arm. Currents and signs of one board are
/// dangerous on another.
THIMBLE_EXPORT driver::Result<void> check_fits(const ArmFile& file, const driver::FoundArm& arm);

/// Opens the link to an arm for exclusive use by this program, and starts the arm. A Falcon gets
/// the firmware file that the user named; without a file it gets none. The user then homes it by
/// hand, following printed instructions. A WoodenHaptics arm on its mbed board must identify itself
/// by its reports before anything is sent. A board on USB serial must match the arm file. A service
/// must identify itself by its first message as Haply's, with this arm connected.
THIMBLE_EXPORT driver::Result<std::unique_ptr<driver::ArmLink>> open_link(
    const driver::FoundArm& arm, const ArmFile& file, const std::filesystem::path& firmware,
    driver::Clock& clock);

}  // namespace thimble::scene
