#pragma once

#include <filesystem>
#include <string>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/identify.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::bringup {

/// Date and arm of an identification.
struct IdentifiedMark {
  std::string date;  ///< "2026-11-23"
  std::string arm;   ///< The arm's name or serial number; "sim" for the simulated one.
};

/// Returns an arm file's text with identified constants instead of its own. They are mass,
/// friction, weight and delay of its section `simulation`, motors and elastic cables if these were
/// seen, and the torque constants. Each is followed by date, arm and interval; all other lines are
/// unchanged. Fails if the text has no section `simulation`, or a form that cannot be changed.
/// Real-time: never from the servo thread.
driver::Result<std::string> identified_text(const std::string& text, const ArmConstants& constants,
                                            const IdentifiedMark& mark);

/// Returns a value as written after its key, marked with unit, date, arm and interval.
std::string marked(double value, const std::string& unit, double plus_minus,
                   const IdentifiedMark& mark);

/// Returns an error if the new file already exists. Real-time: never from the servo thread.
driver::Result<void> check_new_file(const std::filesystem::path& new_file);

/// Writes that text to a new file. Fails if the file already exists: no user's file is overwritten.
/// Real-time: never from the servo thread.
driver::Result<void> write_identified(const std::filesystem::path& arm_file,
                                      const std::filesystem::path& new_file,
                                      const ArmConstants& constants, const IdentifiedMark& mark);

/// Writes all results for which an arm file has keys (`further_text`). A bad fit is written too and
/// marked: the reasons are at the top of the file, and BAD FIT is in every mark.
driver::Result<void> write_identified(const std::filesystem::path& arm_file,
                                      const std::filesystem::path& new_file,
                                      const Identified& found, const IdentifiedMark& mark);

}  // namespace thimble::bringup
