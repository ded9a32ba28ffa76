#pragma once

#include <filesystem>
#include <string>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/identify.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::bringup {

/// When and on which arm constants were identified.
struct IdentifiedMark {
  std::string date;  ///< "2026-11-23"
  std::string arm;   ///< The arm's name or serial number; "sim" for the simulated one.
};

/// Returns an arm file's text with identified constants in place of its own: mass, friction, weight
/// and delay of its section `simulation`, motors and cables if they were seen to stretch, and the
/// torque constants. Each is marked with date, arm
/// and interval behind it; all other lines stay as they are. Fails if the text has no section
/// `simulation`, or a form in which that cannot be done. Real-time: never from the servo thread.
driver::Result<std::string> identified_text(const std::string& text, const ArmConstants& constants,
                                            const IdentifiedMark& mark);

/// Returns a value as it stands behind its key, marked with unit, date, arm and interval.
std::string marked(double value, const std::string& unit, double plus_minus,
                   const IdentifiedMark& mark);

/// Says that a new file would be written over one that is there already. Real-time: never from the
/// servo thread.
driver::Result<void> check_new_file(const std::filesystem::path& new_file);

/// Writes that into a new file. Fails if there is one already: nobody's own file is written over.
/// Real-time: never from the servo thread.
driver::Result<void> write_identified(const std::filesystem::path& arm_file,
                                      const std::filesystem::path& new_file,
                                      const ArmConstants& constants, const IdentifiedMark& mark);

/// Writes all that was found that an arm file has keys for (`further_text`). A bad fit is written
/// too, as one: what speaks against it stands above the file, and BAD FIT in every mark.
driver::Result<void> write_identified(const std::filesystem::path& arm_file,
                                      const std::filesystem::path& new_file,
                                      const Identified& found, const IdentifiedMark& mark);

}  // namespace thimble::bringup
