#pragma once

#include <spdlog/logger.h>

#include <filesystem>
#include <memory>
#include <string>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

// Console and file logging. Levels: info for events, warn for events that the user should check,
// error for failures; debug and trace for debugging.
//
// Before `begin_log` there is console output but no log file, which suits programs that use Thimble
// as a library. From any thread, except `begin_log`. Real-time: none of these functions may be
// called from the servo thread.

/// Returns the main logger: warnings and errors on the console ("thimble: ..."), all messages in
/// the file.
THIMBLE_EXPORT spdlog::logger& logger();

/// Returns the logger for prompts and answers at the terminal: unchanged on the console, and in the
/// file.
THIMBLE_EXPORT spdlog::logger& terminal();

/// Returns a logger for events of a run called `run`: in the file, and on the console if the user
/// requested more output.
THIMBLE_EXPORT std::shared_ptr<spdlog::logger> run_logger(const std::string& run);

/// Verbosity of the console.
enum class Verbosity {
  kQuiet,   ///< Errors only.
  kNormal,  ///< Errors and warnings.
  kDebug,   ///< Also events.
  kTrace,   ///< All messages, also in the file.
};

/// Returns the verbosity of the console requested from `begin_log`.
THIMBLE_EXPORT Verbosity verbosity();

/// Logging options of a process.
struct LogChoice {
  Verbosity verbosity = Verbosity::kNormal;
  std::filesystem::path file = {};  ///< Log file; empty: `default_log_file`, which rotates.
  std::string heading = {};         ///< First message in the file: program and command.
};

/// Starts logging to a file. Fails if a file named by the user cannot be written. If the default
/// file cannot be written, the user is informed with the first message. Call it before other
/// threads log.
THIMBLE_EXPORT driver::Result<void> begin_log(const LogChoice& choice);

/// Returns the default log file of a process: in the state folder.
THIMBLE_EXPORT std::filesystem::path default_log_file();

}  // namespace thimble::scene
