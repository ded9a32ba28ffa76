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

/// The arm file of a real arm, and why it is that one.
struct RealArmFile {
  std::filesystem::path path;     ///< The installed file.
  ArmFile file;                   ///< What it says, with the arm's own calibration in it.
  std::string why;                ///< "named by --arm", say.
  std::vector<std::string> told;  ///< What a file from elsewhere tightened, a sentence each.
};

/// How the arm file of a real arm is looked for.
struct RealArmSearch {
  std::filesystem::path arm_file;  ///< What the user named by --arm; empty: nothing.
  bool for_calibration = false;    ///< Leaves the calibration of before out, even a damaged one.
  /// Asks a board for its model number, in place of the board itself; for tests.
  std::function<driver::Result<int>(const driver::FoundArm&)> ask_model = {};
};

/// Returns the arm file of a real arm: the file that the user named, else the one that its
/// calibration was found with, else the one that its kind or its board's model number means. A
/// scene has no say.
///
/// Only an installed file (shipped_files.h) says what a real arm is made of and what it may do. A
/// file from elsewhere must agree with the installed one in all but its limits, of which the
/// tighter ones are taken.
///
/// The error says what to type: where nothing tells which arm it is, where a file from elsewhere
/// differs, where a calibration belongs to another arm file, or where a file is wrong.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<RealArmFile> find_real_arm_file(const driver::FoundArm& arm,
                                                              const RealArmSearch& search = {});

}  // namespace thimble::scene
