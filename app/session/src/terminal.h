#pragma once

#include <functional>
#include <string>

#include "enter_key.h"
#include "thimble/driver/export.h"

namespace thimble::session {

/// Terminal of the user; replaced in tests.
struct Terminal {
  bool there = false;  ///< True if a user can be asked.
  /// Returns the action of the user, without waiting.
  std::function<EnterKey()> key;
  std::function<void(const std::string&)> print_line;  ///< Prints a line.
  /// Prints a question; the line stays open for the answer.
  std::function<void(const std::string&)> ask = {};
};

/// Returns the terminal on standard input and error. Real-time: never from the servo thread.
THIMBLE_EXPORT Terminal user_terminal();

}  // namespace thimble::session
