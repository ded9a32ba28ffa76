#pragma once

#include <spdlog/logger.h>

#include <filesystem>
#include <memory>
#include <string>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

// Who says what to a person. Levels: info for what happened, warn for what the user should look at,
// error for what failed; debug and trace for whoever searches a fault.
//
// Until `begin_log` there is a console and no file, as suits a program of somebody else's.
// From any thread, but for `begin_log`. Real-time: never from the servo thread.

/// Returns what speaks to the user: warnings and errors on the console ("thimble: ..."), and all
/// of it in the file.
THIMBLE_EXPORT spdlog::logger& logger();

/// Returns what a person at the terminal is asked and answers to: on the console word by word, and
/// in the file.
THIMBLE_EXPORT spdlog::logger& terminal();

/// Returns a logger for what happens in a run called `run`: in the file, and on the console where
/// the user wants to hear more.
THIMBLE_EXPORT std::shared_ptr<spdlog::logger> run_logger(const std::string& run);

/// How much a person hears on the console.
enum class Talk {
  kQuiet,   ///< Errors.
  kNormal,  ///< Warnings as well.
  kDebug,   ///< And what happens.
  kTrace,   ///< And all of it, which the file then holds as well.
};

/// Returns how much a person hears on the console, as `begin_log` was asked.
THIMBLE_EXPORT Talk talk();

/// Where a process logs to.
struct LogChoice {
  Talk talk = Talk::kNormal;
  std::filesystem::path file = {};  ///< Empty: `default_log_file`, which rotates.
  std::string heading = {};         ///< What the file hears first: which program, and its command.
};

/// Begins to log to a file as well. Fails if a file that the user named cannot be written; where
/// the default one cannot be, he is told with the first message. Before other threads log.
THIMBLE_EXPORT driver::Result<void> begin_log(const LogChoice& choice);

/// Returns the file that a process logs to unless it is told another: below the state folder.
THIMBLE_EXPORT std::filesystem::path default_log_file();

}  // namespace thimble::scene
