#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "thimble/driver/discovery.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

/// Arm file chosen for a real arm, with the reason.
struct RealArmFile {
  std::filesystem::path path;  ///< Path of the installed file.
  ArmFile file;                ///< Contents, including the calibration of this arm.
  std::string why;             ///< Reason for the choice, such as "named by --arm".
  /// Warnings about limits tightened by a file that is not installed, one sentence each.
  std::vector<std::string> warnings;
};

/// Options of the search for the arm file of a real arm.
struct RealArmSearch {
  std::filesystem::path arm_file;  ///< Value of --arm; empty: not given.
  bool for_calibration = false;    ///< Ignores the existing calibration, even a damaged one.
  /// For tests: returns the model number instead of querying the board.
  std::function<driver::Result<int>(const driver::FoundArm&)> ask_model = {};
};

/// Returns the arm file of a real arm. It is the file named by the user, or else the file with
/// which its calibration was made. Without either it is the file for the arm's kind or its board's
/// model number. A scene cannot change the choice.
///
/// Only an installed file (shipped_files.h) defines the construction and limits of a real arm. Any
/// other file must agree with the installed one in everything except its limits. Of each limit the
/// stricter value is used.
///
/// The error says which command to use. Causes are an arm that cannot be identified, an invalid
/// file, a file that differs from the installed one, or a calibration of another arm file.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<RealArmFile> find_real_arm_file(const driver::FoundArm& arm,
                                                              const RealArmSearch& search = {});

}  // namespace thimble::scene
