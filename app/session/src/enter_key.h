#pragma once

#include "thimble/driver/export.h"

namespace thimble::session {

/// What the user did at the terminal since the last look.
enum class EnterKey {
  kNothing,
  kPressed,
  kClosed,  ///< Nobody is there and nobody will come: the input has ended.
};

/// Looks, without waiting, whether the user pressed Enter. Real-time: never from the servo thread.
THIMBLE_EXPORT EnterKey look_for_enter();

}  // namespace thimble::session
