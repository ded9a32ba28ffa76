#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace thimble::bringup {

/// Severity of a finding.
enum class Health {
  kGood,     ///< No problem.
  kAdvice,   ///< Works, but touch may suffer.
  kProblem,  ///< The arm cannot be used in this state.
};

/// One result of the doctor.
struct Finding {
  Health health = Health::kGood;
  std::string what;    ///< One sentence.
  std::string remedy;  ///< Remedy: a command or an action; empty if nothing is wrong.
};

/// The machine under examination; tests pass one of their own.
struct SystemInfo {
  std::filesystem::path root = "/";  ///< All data of the kernel are read below it.
  long real_time_priority_max = 0;   ///< This user's RLIMIT_RTPRIO.
  bool in_plugdev = false;           ///< This user is in the group plugdev.
};

/// Returns the location of the program's log, and whether it is writable. Changes nothing.
/// Real-time: never from the servo thread.
Finding examine_log(const std::filesystem::path& file);

/// Returns the data of this machine and user. Real-time: never from the servo thread.
SystemInfo this_machine();

/// Finds reasons why an arm cannot be used or touch may suffer. Examines the udev rule, each arm's
/// node, access, driver, hub, power saving and latency timer, and the timing of a loop. Opens and
/// changes nothing. Real-time: never from the servo thread.
std::vector<Finding> examine(const SystemInfo& system);

}  // namespace thimble::bringup
