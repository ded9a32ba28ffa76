#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace thimble::bringup {

/// How bad a finding is.
enum class Health {
  kGood,     ///< As it should be.
  kAdvice,   ///< Works, but touch may suffer.
  kProblem,  ///< The arm cannot be used like this.
};

/// One thing that the doctor looked at.
struct Finding {
  Health health = Health::kGood;
  std::string what;  ///< One sentence.
  std::string mend;  ///< A command or an act that mends it; empty if nothing is wrong.
};

/// The machine as the doctor sees it; tests give one of their own.
struct SystemInfo {
  std::filesystem::path root = "/";  ///< Everything the kernel tells is read below it.
  long real_time_priority_max = 0;   ///< This user's RLIMIT_RTPRIO.
  bool in_plugdev = false;           ///< This user is in the group plugdev.
};

/// Returns where the program logs to, and whether it may write there. Changes nothing.
/// Real-time: never from the servo thread.
Finding examine_log(const std::filesystem::path& file);

/// Looks at this machine and user. Real-time: never from the servo thread.
SystemInfo this_machine();

/// Examines why an arm cannot be used or touch may suffer: the udev rule, each arm's node, access,
/// driver, hub, power saving and latency timer, and how evenly a loop can run. Opens and
/// changes nothing. Real-time: never from the servo thread.
std::vector<Finding> examine(const SystemInfo& system);

}  // namespace thimble::bringup
