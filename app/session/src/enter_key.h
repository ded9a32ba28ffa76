#pragma once

#include "thimble/driver/export.h"

namespace thimble::session {

/// Action of the user at the terminal since the last check.
enum class EnterKey {
  kNothing,
  kPressed,
  kClosed,  ///< The input has ended.
};

/// Checks, without waiting, whether the user pressed Enter. Real-time: never from the servo thread.
THIMBLE_EXPORT EnterKey check_enter_key();

}  // namespace thimble::session
