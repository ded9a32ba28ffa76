#pragma once

#include <functional>
#include <string>

#include "enter_key.h"
#include "thimble/driver/export.h"

namespace thimble::session {

/// The user at the terminal; tests write their own.
struct Terminal {
  bool there = false;                            ///< Somebody can be asked.
  std::function<EnterKey()> key;                 ///< Looks, without waiting, what he did.
  std::function<void(const std::string&)> tell;  ///< Shows him a line.
  std::function<void(const std::string&)> ask =
      {};  ///< Shows him a question; the line stays open for the answer.
};

/// Returns standard input and error. Real-time: never from the servo thread.
THIMBLE_EXPORT Terminal user_terminal();

}  // namespace thimble::session
